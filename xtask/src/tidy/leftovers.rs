//! Unfinished code is not merged.

use super::finding::Finding;
use super::tree::Tree;

/// Notes to oneself, anywhere in a file. Written in halves, which keeps this file clean.
const NOTES: [&str; 3] = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];
/// Holes in code, tests too.
const HOLES: [&str; 3] = [concat!("to", "do!("), concat!("unimpl", "emented!("), concat!("#[ign", "ore")];

/// Checks all sources and documents.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in tree.files.iter().filter(|file| !file.path.ends_with(".lock")) {
        let holes: &[&str] = if file.path.ends_with(".rs") { &HOLES } else { &[] };
        for (i, line) in file.text.lines().enumerate() {
            for word in NOTES.iter().filter(|word| stands_alone(line, word)) {
                findings.push(Finding::error(&file.path, i + 1, format!("{word}: do it, or open an issue")));
            }
            for hole in holes.iter().filter(|hole| line.contains(**hole)) {
                findings.push(Finding::error(
                    &file.path,
                    i + 1,
                    format!("`{hole}`: finish it, or take it out"),
                ));
            }
        }
    }
    findings
}

fn stands_alone(line: &str, word: &str) -> bool {
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    line.match_indices(word).any(|(at, _)| {
        !is_word(line[..at].chars().next_back()) && !is_word(line[at + word.len()..].chars().next())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn notes_and_holes_are_found_with_their_lines() {
        let code = format!(
            "fn f() {{\n    // {}: later\n    {})\n}}\n{}]\nfn g() {{}}",
            NOTES[0], HOLES[0], HOLES[2]
        );
        let found = check(&tree(&[("a.rs", &code), ("b.md", "a mastodon\n")]));
        assert_eq!(found.iter().map(|f| f.line).collect::<Vec<_>>(), [2, 3, 5]);
    }
}
