//! The page of the libraries: each crate with its description.

use super::finding::Finding;
use super::tree::{Package, Tree};

const PAGE: &str = "docs/libraries.md";
/// Folder of the crates.
const CRATES: &str = "crates/";

/// Checks that the page lists each crate, with the description of its manifest.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(page) = tree.file(PAGE) else { return Vec::new() };
    let crates = tree.packages.iter().filter(|package| package.folder.starts_with(CRATES));
    let rows = crates.map(row).filter(|row| !page.text.lines().any(|line| line == row));
    rows.map(|row| Finding::error(PAGE, 1, format!("the row is missing: {row}"))).collect()
}

/// The row of a crate.
fn row(package: &Package) -> String {
    let description = package.manifest.get("package").and_then(|table| table.get("description"));
    let description = description.and_then(toml::Value::as_str).unwrap_or_default();
    format!("| [`{}`](../{}/src/lib.rs) | {description} |", package.name, package.folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn a_crate_without_its_row_is_found() {
        let manifest = |name: &str| format!("[package]\nname = \"{name}\"\ndescription = \"Of {name}.\"\n");
        let page = "| [`a`](../crates/a/src/lib.rs) | Of a. |\n| [`b`](../crates/b/src/lib.rs) | Of c. |\n";
        let files = [
            (PAGE, page),
            ("crates/a/Cargo.toml", &manifest("a")),
            ("crates/b/Cargo.toml", &manifest("b")),
            ("xtask/Cargo.toml", &manifest("xtask")),
        ];
        let found: Vec<String> = check(&tree(&files)).iter().map(Finding::to_string).collect();
        let row = "| [`b`](../crates/b/src/lib.rs) | Of b. |";
        assert_eq!(found, [format!("{PAGE}:1: the row is missing: {row}")]);
    }
}
