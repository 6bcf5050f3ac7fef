//! Links that lead somewhere, and algorithms that can be found.

use super::finding::Finding;
use super::tree::{File, Tree};

const ARCHITECTURE: &str = "ARCHITECTURE.md";

/// Checks every relative link, and that the architecture links every algorithm's page.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings: Vec<Finding> = tree.ending(".md").flat_map(|file| broken_links(tree, file)).collect();
    if let Some(architecture) = tree.file(ARCHITECTURE) {
        let linked: Vec<String> = links(&architecture.text).into_iter().map(|(_, link)| link).collect();
        let pages =
            tree.files.iter().filter(|f| f.path.starts_with("docs/algorithms/") && f.path.ends_with(".md"));
        let hidden = pages.filter(|page| !linked.contains(&page.path));
        findings.extend(
            hidden.map(|page| Finding::error(&page.path, 1, format!("not linked from {ARCHITECTURE}"))),
        );
    }
    findings
}

fn broken_links(tree: &Tree, file: &File) -> Vec<Finding> {
    let exists = |path: &str| {
        let inside = tree.files.iter().any(|f| f.path == path || f.path.starts_with(&format!("{path}/")));
        inside || crate::workspace::root().join(path).exists()
    };
    let broken = links(&file.text).into_iter().filter(|(_, link)| !exists(&resolve(&file.path, link)));
    broken
        .map(|(line, link)| Finding::error(&file.path, line, format!("the link {link} leads nowhere")))
        .collect()
}

/// Relative links with their lines, without anchors; code is not a link.
fn links(text: &str) -> Vec<(usize, String)> {
    let (mut found, mut fenced) = (Vec::new(), false);
    for (i, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        }
        if fenced {
            continue;
        }
        let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("``");
        for piece in prose.split("](").skip(1) {
            let Some(link) = piece.split(')').next() else { continue };
            let link = link.split(['#', ' ']).next().unwrap_or(link);
            if !link.is_empty() && !link.contains("://") && !link.starts_with("mailto:") {
                found.push((i + 1, link.to_owned()));
            }
        }
    }
    found
}

/// A link of the file at `from`, relative to the workspace.
fn resolve(from: &str, link: &str) -> String {
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in link.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            other => parts.push(other),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn broken_links_and_hidden_pages_are_found() {
        let tree = tree(&[
            (
                ARCHITECTURE,
                "[orb](docs/algorithms/orb.md#x) [web](https://a.b) `[no](link)`\n[gone](docs/gone.md)\n",
            ),
            ("docs/algorithms/orb.md", "[up](../../ARCHITECTURE.md) ![picture](no.png)"),
            ("docs/algorithms/slam.md", "```\n[no](link)\n```\n[here](#anchor) [folder](..)"),
        ]);
        let found: Vec<String> = check(&tree).iter().map(Finding::to_string).collect();
        assert_eq!(
            found,
            [
                "ARCHITECTURE.md:2: the link docs/gone.md leads nowhere",
                "docs/algorithms/orb.md:1: the link no.png leads nowhere",
                "docs/algorithms/slam.md:1: not linked from ARCHITECTURE.md",
            ]
        );
    }
}
