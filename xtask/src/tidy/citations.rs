//! Every work that is cited can be found.

use super::finding::Finding;
use super::tree::Tree;

const BIBLIOGRAPHY: &str = "docs/bibliography.md";

/// Checks that each key in brackets, as `Ge00`, has an entry in the bibliography.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let Some(bibliography) = tree.file(BIBLIOGRAPHY) else { return Vec::new() };
    let mut findings = Vec::new();
    for file in tree.files.iter().filter(|f| f.path.ends_with(".rs") || f.path.ends_with(".md")) {
        for (i, line) in file.text.lines().enumerate() {
            for key in keys(line) {
                if !bibliography.text.contains(&format!("**[{key}]**")) {
                    findings.push(Finding::error(
                        &file.path,
                        i + 1,
                        format!("{key} is not in {BIBLIOGRAPHY}"),
                    ));
                }
            }
        }
    }
    findings
}

/// The keys cited in a line: `[A87]`, `\[A87\]`, `[A87, B91]`.
fn keys(line: &str) -> impl Iterator<Item = &str> {
    let brackets = line.split('[').skip(1).filter_map(|piece| piece.split_once(']'));
    let inner = brackets.map(|(inner, _)| inner.trim_end_matches('\\'));
    let lists = inner.filter(|inner| inner.split(", ").all(is_key));
    lists.flat_map(|inner| inner.split(", "))
}

/// A name that begins with a capital, and two digits of a year.
fn is_key(word: &str) -> bool {
    let name = word.trim_end_matches(|c: char| c.is_ascii_digit());
    let letters = name.len() >= 2 && name.chars().all(|c| c.is_ascii_alphabetic());
    let small = name.chars().any(|c| c.is_ascii_lowercase());
    letters && small && name.starts_with(|c: char| c.is_ascii_uppercase()) && word.len() == name.len() + 2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn unknown_works_are_found() {
        let text = format!("//! \\[{}00\\] and [{}90, {}99], [f32; 10] [X1] [Vector2]\n", "Ge", "Old", "New");
        let bibliography = format!("- **[{}00]** a\n- **[{}90]** b\n", "Ge", "Old");
        let found = check(&tree(&[(BIBLIOGRAPHY, &bibliography), ("a.rs", &text)]));
        assert_eq!(
            found.iter().map(Finding::to_string).collect::<Vec<_>>(),
            ["a.rs:1: New99 is not in docs/bibliography.md"]
        );
    }
}
