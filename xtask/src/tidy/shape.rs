//! Files that fit a head, and crates that say what they are.

use super::finding::Finding;
use super::tree::Tree;

/// Lines of code above which a file is warned of.
const MANY_LINES: usize = 400;
/// Lines of code above which a file is an error.
const TOO_MANY_LINES: usize = 600;

/// Checks sizes of files and the crates' own words.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &tree.packages {
        for source in tree.sources(package) {
            let (path, lines) = (&source.file.path, source.code.len());
            let message = format!("{lines} lines of code; files have about 100 to 150");
            if lines > TOO_MANY_LINES {
                findings.push(Finding::error(path, 1, format!("{message}, {TOO_MANY_LINES} at most")));
            } else if lines > MANY_LINES {
                findings.push(Finding::warning(path, 1, message));
            }
        }
        for root in ["lib.rs", "main.rs"] {
            let path = format!("{}/src/{root}", package.folder);
            if tree.file(&path).is_some_and(|file| !file.text.starts_with("//!")) {
                findings.push(Finding::error(&path, 1, "a crate begins with its documentation (`//!`)"));
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    fn findings(lib: &str) -> Vec<String> {
        let tree = tree(&[("x/Cargo.toml", "[package]\nname = \"x\""), ("x/src/lib.rs", lib)]);
        check(&tree).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn long_files_and_silent_crates_are_found() {
        let lib = |lines: usize| format!("//! X.\n{}", "f();\n".repeat(lines));
        assert!(findings(&lib(400)).is_empty());
        assert!(findings(&lib(401))[0].contains("warning: 401 lines"));
        assert!(findings(&lib(601))[0].starts_with("x/src/lib.rs:1: 601 lines"));
        assert!(findings("fn f() {}")[0].contains("begins with its documentation"));
    }
}
