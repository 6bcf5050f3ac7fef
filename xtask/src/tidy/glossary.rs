//! Names: the glossary's second table lists those that modules, types, functions and constants must not have.

use super::finding::{Finding, Rule};
use super::tree::Tree;
use std::collections::BTreeMap;

const GLOSSARY: &str = "docs/glossary.md";
const TABLE: &str = "## Names that are not used";
/// Keywords after which a name is defined.
const KEYWORDS: [&str; 8] = ["mod", "struct", "enum", "trait", "type", "fn", "const", "static"];

/// Checks the definitions of every package.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(glossary) = tree.file(GLOSSARY) else { return Vec::new() };
    let refused = refused(&glossary.text);
    let mut findings = Vec::new();
    for source in tree.packages.iter().flat_map(|package| tree.sources(package)) {
        for (line, code) in source.code.lines() {
            for name in defined(code) {
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

/// The names that a line of code defines.
fn defined(code: &str) -> impl Iterator<Item = &str> {
    let words: Vec<&str> =
        code.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty()).collect();
    let pairs: Vec<&str> =
        words.windows(2).filter(|pair| KEYWORDS.contains(&pair[0])).map(|pair| pair[1]).collect();
    pairs.into_iter()
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
