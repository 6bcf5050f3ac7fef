//! Links that lead somewhere, and algorithms that can be found.

use super::finding::Finding;
use super::tree::{File, Tree};
use crate::markdown::{anchors, links};

const ARCHITECTURE: &str = "ARCHITECTURE.md";

/// Checks every relative link, and that the architecture links every algorithm's page.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings: Vec<Finding> = tree.ending(".md").flat_map(|file| broken_links(tree, file)).collect();
    findings.extend(tree.ending(".md").flat_map(|file| broken_anchors(tree, file)));
    if let Some(architecture) = tree.file(ARCHITECTURE) {
        let linked: Vec<String> = links(&architecture.text).into_iter().map(|link| link.path).collect();
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
    let broken = links(&file.text).into_iter().filter(|link| !exists(&link.target(&file.path)));
    broken
        .map(|link| Finding::error(&file.path, link.line, format!("the link {} leads nowhere", link.path)))
        .collect()
}

/// Links to a heading that its page does not have.
fn broken_anchors(tree: &Tree, file: &File) -> Vec<Finding> {
    let broken = links(&file.text).into_iter().filter(|link| {
        let page = tree.file(&link.target(&file.path)).filter(|page| page.path.ends_with(".md"));
        link.anchor.as_ref().zip(page).is_some_and(|(anchor, page)| !anchors(&page.text).contains(anchor))
    });
    broken
        .map(|link| {
            let anchor = link.anchor.unwrap_or_default();
            Finding::error(
                &file.path,
                link.line,
                format!("{}#{anchor}: no heading has this anchor", link.path),
            )
        })
        .collect()
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
                "[orb](docs/algorithms/orb.md#b-c) [gone](docs/algorithms/orb.md#b) [web](https://a.b) `[no](link)`\n[gone](docs/gone.md)\n",
            ),
            ("docs/algorithms/orb.md", "[up](../../ARCHITECTURE.md) ![picture](no.png)\n## B: `c`"),
            ("docs/algorithms/slam.md", "```\n[no](link)\n```\n[here](#anchor) [folder](..)\n# Anchor"),
        ]);
        let found: Vec<String> = check(&tree).iter().map(Finding::to_string).collect();
        assert_eq!(
            found,
            [
                "ARCHITECTURE.md:2: the link docs/gone.md leads nowhere",
                "docs/algorithms/orb.md:1: the link no.png leads nowhere",
                "ARCHITECTURE.md:1: docs/algorithms/orb.md#b: no heading has this anchor",
                "docs/algorithms/slam.md:1: not linked from ARCHITECTURE.md",
            ]
        );
    }
}
