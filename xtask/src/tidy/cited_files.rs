//! Documents only name existing files: paths in code spans that begin with a folder of the workspace.

use super::finding::{Finding, Rule};
use super::tree::{File, Tree};

/// First folders of paths that are checked.
const FOLDERS: [&str; 11] = [
    "crates/",
    "apps/",
    "bench/",
    "data/",
    "docs/",
    "xtask/",
    "fuzz/",
    "packaging/",
    "python/",
    "results/",
    ".ci/",
];

/// Checks every document.
pub fn check(tree: &Tree) -> Vec<Finding> {
    tree.ending(".md").flat_map(|file| missing(tree, file)).collect()
}

fn missing(tree: &Tree, file: &File) -> Vec<Finding> {
    let exists = |path: &str| {
        let folder = format!("{}/", path.trim_end_matches('/'));
        tree.files.iter().any(|f| f.path == path || f.path.starts_with(&folder))
            || crate::workspace::root().join(path).exists()
    };
    let mut findings = Vec::new();
    for (i, line) in file.text.lines().enumerate() {
        for span in line.split('`').skip(1).step_by(2) {
            let span = span.strip_prefix("bash ").unwrap_or(span);
            let path = span.split([' ', ':', '#']).next().unwrap_or(span);
            let is_path = FOLDERS.iter().any(|folder| path.starts_with(folder));
            let is_pattern =
                path.contains(['*', '{', '<', '$']) || path.contains("NAME") || path.contains("...");
            if is_path && !is_pattern && !exists(path) {
                let message = format!("{path} is not there");
                findings.push(Finding::ruled(Rule::MissingFile, &file.path, i + 1, message));
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn files_that_are_not_there_are_found() {
        let text = "`docs/a.md`, `docs/gone.md`, `results/*.json`, `crates/x/src/lib.rs:3`, `docs/`, `out/x`, `bash bench/gone.sh x`\n";
        let found = check(&tree(&[("docs/a.md", text), ("crates/x/src/lib.rs", "")]));
        let messages: Vec<&str> = found.iter().map(|finding| finding.message.as_str()).collect();
        assert_eq!(messages, ["docs/gone.md is not there", "bench/gone.sh is not there"]);
    }
}
