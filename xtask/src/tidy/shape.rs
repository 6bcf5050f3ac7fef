//! Sizes of files and of the command line, and crates that begin with their documentation.

use super::finding::Finding;
use super::tree::{Package, Tree};

/// Lines of code above which a file is warned of. Source: ours.
const MANY_LINES: usize = 400;
/// Lines of code above which a file is an error. Source: ours.
const TOO_MANY_LINES: usize = 600;

/// The crate of the command line.
const COMMAND_LINE: &str = "trundle-cli";
/// Maximum number of lines of the command line's code; more code belongs in a crate shared by all front ends. Source: ours.
const MAX_COMMAND_LINE_LINES: usize = 3000;

/// Checks sizes of files and of the command line, and the crates' own documentation.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for package in &tree.packages {
        findings.extend(large_command_line(tree, package));
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

/// An error if the command line holds more than command line.
fn large_command_line(tree: &Tree, package: &Package) -> Option<Finding> {
    let lines: usize = tree.sources(package).map(|source| source.code.len()).sum();
    let message = format!(
        "{lines} lines of code, {MAX_COMMAND_LINE_LINES} at most: move what is not a command line to app"
    );
    let is_large = package.name == COMMAND_LINE && lines > MAX_COMMAND_LINE_LINES;
    is_large.then(|| Finding::error(&format!("{}/src", package.folder), 1, message))
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

    #[test]
    fn the_command_line_is_small() {
        let tree = |name: &str, lines: usize| {
            let manifest = format!("[package]\nname = \"{name}\"");
            let file = format!("//! X.\n{}", "f();\n".repeat(lines / 10));
            let names: Vec<String> = (0..10).map(|i| format!("x/src/f{i}.rs")).collect();
            let sources = names.iter().map(|name| (name.as_str(), file.as_str()));
            tree(&std::iter::once(("x/Cargo.toml", manifest.as_str())).chain(sources).collect::<Vec<_>>())
        };
        assert!(check(&tree(COMMAND_LINE, MAX_COMMAND_LINE_LINES)).is_empty());
        assert!(check(&tree("trundle-io", MAX_COMMAND_LINE_LINES + 10)).is_empty());
        let found = check(&tree(COMMAND_LINE, MAX_COMMAND_LINE_LINES + 10));
        let lines = format!("{} lines of code", MAX_COMMAND_LINE_LINES + 10);
        assert!(found[0].message.starts_with(&lines), "{found:?}");
    }
}
