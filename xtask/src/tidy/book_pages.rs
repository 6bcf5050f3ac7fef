//! Pages of the book: the summary lists each page of `docs` once.

use super::finding::Finding;
use super::tree::{File, Tree};
use crate::markdown::links;

const SUMMARY: &str = "docs/SUMMARY.md";

/// Checks that the book's summary lists every page of `docs` exactly once, and no other file.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(summary) = tree.file(SUMMARY) else { return Vec::new() };
    let listed: Vec<(usize, String)> =
        links(&summary.text).iter().map(|link| (link.line, link.target(SUMMARY))).collect();
    let pages = tree.ending(".md").map(|file| &file.path);
    let pages = pages.filter(|path| path.starts_with("docs/") && *path != SUMMARY);
    let hidden = pages.filter(|path| !listed.iter().any(|(_, page)| page == *path));
    let mut findings: Vec<Finding> =
        hidden.map(|path| Finding::error(path, 1, format!("not listed in {SUMMARY}"))).collect();
    for (i, (line, page)) in listed.iter().enumerate() {
        if listed.iter().take(i).any(|(_, earlier)| earlier == page) {
            findings.push(Finding::error(SUMMARY, *line, format!("{page} is listed twice")));
        }
        if !page.starts_with("docs/") || !page.ends_with(".md") {
            findings.push(Finding::error(SUMMARY, *line, format!("{page} is no page of docs")));
        }
    }
    findings.extend(tree.ending(".md").flat_map(|page| folder_links(tree, page)));
    findings
}

/// Links of a page to a folder of `docs`, for which the book has no page.
fn folder_links(tree: &Tree, page: &File) -> Vec<Finding> {
    let links = if page.path.starts_with("docs/") { links(&page.text) } else { Vec::new() };
    let is_folder = |path: &str| {
        path.starts_with("docs/") && tree.files.iter().any(|f| f.path.starts_with(&format!("{path}/")))
    };
    let found = links.into_iter().filter(|link| is_folder(&link.target(&page.path)));
    found
        .map(|link| {
            let message = format!("the link {} leads to a folder, expected a page of docs", link.path);
            Finding::error(&page.path, link.line, message)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn hidden_repeated_and_foreign_pages_are_found() {
        let summary = "[a](a.md)\n[b](how-to/b.md)\n[a](a.md)\n[readme](../README.md)\n";
        let pages = [
            (SUMMARY, summary),
            ("docs/a.md", "[b](how-to)"),
            ("docs/how-to/b.md", ""),
            ("docs/how-to/c.md", ""),
        ];
        let found: Vec<String> = check(&tree(&pages)).iter().map(Finding::to_string).collect();
        assert_eq!(
            found,
            [
                "docs/how-to/c.md:1: not listed in docs/SUMMARY.md",
                "docs/SUMMARY.md:3: docs/a.md is listed twice",
                "docs/SUMMARY.md:4: README.md is no page of docs",
                "docs/a.md:1: the link how-to leads to a folder, expected a page of docs",
            ]
        );
    }
}
