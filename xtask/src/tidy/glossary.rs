//! Names: the glossary's second table lists those that modules, types, functions and constants must not have.

use super::finding::{Finding, Rule};
use super::source::definitions;
use super::tree::Tree;
use std::collections::BTreeMap;

const GLOSSARY: &str = "docs/glossary.md";
const TABLE: &str = "## Names that are not used";
/// Checks the definitions of every package.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(glossary) = tree.file(GLOSSARY) else { return Vec::new() };
    let refused = refused(&glossary.text);
    let mut findings = Vec::new();
    for source in tree.packages.iter().flat_map(|package| tree.sources(package)) {
        for (line, code) in source.code.lines() {
            for (_, name) in definitions(code) {
                if let Some(instead) = refused.get(name) {
                    let message = format!("the name {name} is not used: write {instead} ({GLOSSARY})");
                    findings.push(Finding::ruled(Rule::Glossary, &source.file.path, line, message));
                }
            }
        }
    }
    findings
}

/// The refused names, each with what to write instead.
fn refused(glossary: &str) -> BTreeMap<&str, &str> {
    let table = glossary.split_once(TABLE).map_or("", |(_, table)| table);
    let rows =
        table.lines().filter_map(|line| line.strip_prefix("| ")?.trim_end_matches('|').split_once(" | "));
    let names = rows
        .flat_map(|(left, right)| left.split('`').skip(1).step_by(2).map(move |name| (name, right.trim())));
    names.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn refused_names_are_found_where_they_are_defined() {
        let glossary = format!(
            "| `Used` | x |\n\n{TABLE}\n\n| instead of | write |\n|---|---|\n| `Helm`, `helm` | `Controller` |\n"
        );
        let code = "mod helm;\npub struct Helm;\nfn f(x: Helm) { helm::g() }\nconst Used: u8 = 1;\n";
        let files =
            [("x/Cargo.toml", "[package]\nname = \"x\""), ("x/src/lib.rs", code), (GLOSSARY, &glossary)];
        let found: Vec<usize> = check(&tree(&files)).iter().map(|f| f.line).collect();
        assert_eq!(found, [1, 2]);
    }
}
