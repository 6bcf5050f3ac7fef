//! The design's invariants, checked in the sources.
//!
//! Each file in this folder is one kind of rule. A rule is a function from the workspace's tree to findings; every finding has a file and a
//! line. `cargo test` runs them all as a test.

mod allowed;
mod arrows;
mod book_pages;
mod citations;
mod cited_files;
mod cited_tests;
mod constant_sources;
mod constants;
mod finding;
mod glossary;
mod leftovers;
mod libraries_page;
mod lockfile;
mod manifest;
mod markdown;
mod modules;
mod open_types;
mod prose;
mod purity;
mod results_page;
mod shape;
mod shell_blocks;
mod source;
mod tree;
mod type_names;
mod types;
mod use_paths;

use crate::workspace::Verdict;
use allowed::Allowed;
use finding::{Finding, Severity};
use std::path::Path;
use tree::Tree;

/// Checks the workspace and prints one line per finding. Returns whether no error was found.
pub fn run(root: &Path) -> Verdict {
    let findings = check(root)?;
    for finding in &findings {
        println!("{finding}");
    }
    let errors = findings.iter().filter(|f| f.severity == Severity::Error).count();
    println!("tidy: {errors} errors, {} warnings", findings.len() - errors);
    Ok(errors == 0)
}

/// Lowers the allow-list to the present findings; with `grows` it accepts all findings (for a new rule).
pub fn shrink(root: &Path, grows: bool) -> Verdict {
    let text = allowed(root)?.shrunk(&all_findings(root)?, grows);
    std::fs::write(root.join(allowed::FILE), text)
        .map_err(|e| format!("cannot write {}: {e}", allowed::FILE))?;
    Ok(true)
}

/// The findings that are not allowed, by file and line.
fn check(root: &Path) -> Result<Vec<Finding>, String> {
    Ok(allowed(root)?.apply(all_findings(root)?))
}

fn allowed(root: &Path) -> Result<Allowed, String> {
    let file = root.join(allowed::FILE);
    let text = std::fs::read_to_string(&file).map_err(|e| format!("cannot read {}: {e}", allowed::FILE))?;
    Allowed::parse(&text)
}

/// All findings, by file and line.
fn all_findings(root: &Path) -> Result<Vec<Finding>, String> {
    let tree = Tree::read(root)?;
    let rules = [
        arrows::check,
        book_pages::check,
        citations::check,
        cited_files::check,
        cited_tests::check,
        constant_sources::check,
        constants::check,
        glossary::check,
        purity::check,
        shape::check,
        shell_blocks::check,
        leftovers::check,
        libraries_page::check,
        lockfile::check,
        manifest::check,
        markdown::check,
        modules::check,
        open_types::check,
        type_names::check,
        types::check,
        prose::check,
    ];
    let mut findings: Vec<Finding> = rules.iter().flat_map(|rule| rule(&tree)).collect();
    findings.extend(results_page::check(root));
    findings.sort();
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_is_tidy() {
        let findings = check(&crate::workspace::root()).unwrap();
        let errors: Vec<String> =
            findings.iter().filter(|f| f.severity == Severity::Error).map(Finding::to_string).collect();
        assert!(errors.is_empty(), "\n{}\n", errors.join("\n"));
    }
}
