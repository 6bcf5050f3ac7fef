//! The design's invariants, checked in the sources: what is absent on purpose must stay absent.
//!
//! Each file here is one kind of rule. A rule is a function from the workspace's tree to findings; every finding names a
//! file and a line. `cargo test` runs them all as a test.

mod arrows;
mod citations;
mod finding;
mod leftovers;
mod lockfile;
mod markdown;
mod purity;
mod shape;
mod source;
mod tree;

use crate::Verdict;
use finding::{Finding, Severity};
use std::path::Path;
use tree::Tree;

/// Checks the workspace and prints one line a finding; whether there is no error.
pub fn run(root: &Path) -> Verdict {
    let findings = check(root)?;
    for finding in &findings {
        println!("{finding}");
    }
    let errors = findings.iter().filter(|f| f.severity == Severity::Error).count();
    println!("tidy: {errors} errors, {} warnings", findings.len() - errors);
    Ok(errors == 0)
}

/// All findings, by file and line.
fn check(root: &Path) -> Result<Vec<Finding>, String> {
    let tree = Tree::read(root)?;
    let rules = [
        arrows::check,
        citations::check,
        purity::check,
        shape::check,
        leftovers::check,
        lockfile::check,
        markdown::check,
    ];
    let mut findings: Vec<Finding> = rules.iter().flat_map(|rule| rule(&tree)).collect();
    findings.sort();
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_is_tidy() {
        let findings = check(&crate::root()).unwrap();
        let errors: Vec<String> =
            findings.iter().filter(|f| f.severity == Severity::Error).map(Finding::to_string).collect();
        assert!(errors.is_empty(), "\n{}\n", errors.join("\n"));
    }
}
