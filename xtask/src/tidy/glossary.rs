//! Names: the glossary's second table lists those that are refused for modules, types, functions, fields
//! and variables, in tests too.

use super::finding::{Finding, Rule};
use super::source::identifiers;
use super::tree::Tree;
use std::collections::BTreeMap;

const GLOSSARY: &str = "docs/glossary.md";
const TABLE: &str = "## Names that are not used";

/// Checks all identifiers of every package, in code and tests.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(glossary) = tree.file(GLOSSARY) else { return Vec::new() };
    let refused = refused(&glossary.text);
    let mut findings = Vec::new();
    for source in tree.packages.iter().flat_map(|package| tree.sources_with_tests(package)) {
        for (line, code) in source.code.lines() {
            for name in identifiers(code) {
                if let Some(instead) = instead_of(&refused, name) {
                    let message = format!("the name {name} is not used: write {instead} ({GLOSSARY})");
                    findings.push(Finding::ruled(Rule::Glossary, &source.file.path, line, message));
                }
            }
        }
    }
    findings
}

/// Replacement for a name: by the name itself, or by its beginning, which ends with `*` in the table.
fn instead_of<'a>(refused: &BTreeMap<&str, &'a str>, name: &str) -> Option<&'a str> {
    let by_beginning = || {
        let beginning =
            |refused: &str| refused.strip_suffix('*').is_some_and(|start| name.starts_with(start));
        refused.iter().find(|(refused, _)| beginning(refused)).map(|(_, instead)| *instead)
    };
    refused.get(name).copied().or_else(by_beginning)
}

/// The refused names, each with its replacement.
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
    fn refused_names_are_found_wherever_they_stand() {
        let glossary = format!(
            "| `Used` | x |\n\n{TABLE}\n\n| instead of | write |\n|---|---|\n| `Helm`, `helm` | `Controller` |\n\
             | `least_*` | `min_*` |\n"
        );
        let code = "mod helm;\npub struct Helm;\n// helm\nfn f() { g::helmet(\"helm\") }\nconst Used: u8 = 1;\n\
                    let least_cost = atleast_cost;\n\
                    #[cfg(test)]\nmod tests { fn helm() {} }\n";
        let files = [
            ("x/Cargo.toml", "[package]\nname = \"x\""),
            ("x/src/lib.rs", code),
            ("x/tests/it/a.rs", "fn f() {}\nfn helm() {}\n"),
            (GLOSSARY, &glossary),
        ];
        let found: Vec<usize> = check(&tree(&files)).iter().map(|f| f.line).collect();
        assert_eq!(found, [1, 2, 6, 8, 2]);
    }
}
