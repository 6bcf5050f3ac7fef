//! The golden file: one line a quantity, `case/quantity hash bytes`, sorted by case.

use std::collections::BTreeMap;

/// Digests by key (`case/quantity`).
pub type Digests = BTreeMap<String, String>;

/// Reads the golden file's text.
///
/// # Errors
/// When a line is not a key and a digest, or a key is repeated.
pub fn parse(text: &str) -> Result<Digests, String> {
    let mut digests = Digests::new();
    for (i, line) in text.lines().enumerate().filter(|(_, line)| !line.is_empty() && !line.starts_with('#')) {
        let (key, digest) = line
            .split_once(' ')
            .ok_or_else(|| format!("line {}: '{line}', expected `case/quantity hash bytes`", i + 1))?;
        if digests.insert(key.to_owned(), digest.trim().to_owned()).is_some() {
            return Err(format!("line {}: {key} stands twice", i + 1));
        }
    }
    Ok(digests)
}

/// The golden file's text.
pub fn write(digests: &Digests) -> String {
    let head = "# Written by `cargo xtask golden --update`; CONTRIBUTING.md says when that is right.\n";
    let lines = digests.iter().map(|(key, digest)| format!("{key} {digest}\n"));
    std::iter::once(head.to_owned()).chain(lines).collect()
}

/// Differences between found and expected digests, one line per key. Keys of skipped cases are left out.
pub fn differences(expected: &Digests, found: &Digests, skipped: &[&str]) -> Vec<String> {
    let is_skipped = |key: &str| skipped.iter().any(|case| key.split('/').next() == Some(*case));
    let keys = expected.keys().chain(found.keys().filter(|key| !expected.contains_key(*key)));
    keys.filter(|key| !is_skipped(key))
        .filter_map(|key| match (expected.get(key), found.get(key)) {
            (Some(a), Some(b)) if a == b => None,
            (Some(a), Some(b)) => Some(format!("{key}: expected {a}, found {b}")),
            (Some(_), None) => Some(format!("{key}: in the golden file, but no case gives it")),
            (None, _) => Some(format!("{key}: not in the golden file")),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digests(pairs: &[(&str, &str)]) -> Digests {
        pairs.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect()
    }

    #[test]
    fn a_written_text_is_read() {
        let digests = digests(&[("a/grid", "12ab 5"), ("b/poses", "34cd 6")]);
        assert_eq!(parse(&write(&digests)).unwrap(), digests);
        assert!(parse("a/grid").unwrap_err().contains("line 1"));
        assert!(parse("a/grid 1 2\na/grid 3 4").unwrap_err().contains("twice"));
    }

    #[test]
    fn every_kind_of_difference_is_named() {
        let expected = digests(&[("a/grid", "1 1"), ("a/old", "1 1"), ("c/skipped", "1 1")]);
        let found = digests(&[("a/grid", "2 1"), ("a/new", "1 1")]);
        let differences = differences(&expected, &found, &["c"]);
        assert_eq!(differences.len(), 3, "{differences:?}");
        assert!(differences[0].contains("expected 1 1, found 2 1"));
    }
}
