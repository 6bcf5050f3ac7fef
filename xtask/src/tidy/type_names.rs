//! One name, one type: no two crates of the facade define a public type of the same name.

use super::finding::{Finding, Rule};
use super::source::definitions;
use super::tree::Tree;
use std::collections::BTreeMap;

/// Checks the public types of all crates that the facade can export.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut first: BTreeMap<String, (&str, String)> = BTreeMap::new();
    let mut findings = Vec::new();
    for package in tree.packages.iter().filter(|package| package.folder.starts_with("crates/")) {
        for source in tree.sources(package) {
            for (line, name) in public_types(source.code.text()) {
                let path = &source.file.path;
                let (owner, other) =
                    first.entry(name.clone()).or_insert_with(|| (&package.name, path.clone()));
                if *owner != package.name {
                    let message =
                        format!("type {name} has the name of a type in {other}: rename one of them");
                    findings.push(Finding::ruled(Rule::TypeName, path, line, message));
                }
            }
        }
    }
    findings
}

/// Line and name of each type that is declared `pub`.
fn public_types(code: &str) -> Vec<(usize, String)> {
    code.lines().enumerate().filter_map(|(i, line)| Some((i + 1, public_type(line)?))).collect()
}

fn public_type(line: &str) -> Option<String> {
    let item = line.trim_start().strip_prefix("pub ")?;
    let (keyword, name) = *definitions(item).first()?;
    ["struct", "enum", "trait", "type"].contains(&keyword).then(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::public_types;

    #[test]
    fn only_types_that_are_public() {
        let code = "pub struct A<T>(T);\nstruct B;\n  pub enum C {\npub(crate) struct D;\npub fn e() {}\npub trait F {}\npub type G = u8;\n";
        let found = public_types(code);
        assert_eq!(
            found,
            [(1, "A".to_owned()), (3, "C".to_owned()), (6, "F".to_owned()), (7, "G".to_owned())]
        );
    }
}
