//! Warnings about an input, grouped by kind: their number, and up to three examples.

use std::fmt;

/// Maximum number of stored examples of a kind. Source: ours.
const MAX_EXAMPLES: usize = 3;
/// Maximum number of stored kinds; further kinds are counted together. Source: ours.
const MAX_KINDS: usize = 16;
/// The kind of all problems after the first [`MAX_KINDS`] kinds.
const OTHERS: &str = "other problems";

/// Warnings by kind. Problems that differ only in their numbers are of one kind.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Warnings {
    kinds: Vec<Warning>,
}

/// The warnings of one kind. Its text: the problem, the number of occurrences, and up to three places.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// The problem of the first.
    problem: String,
    /// Number of occurrences.
    count: usize,
    /// The first three places.
    places: Vec<String>,
    /// The problem without its numbers.
    kind: String,
}

impl Warnings {
    /// Adds a problem and its place: a file, a line, a frame. The place may be empty.
    pub fn add(&mut self, problem: &str, place: &str) {
        let kind = without_numbers(problem);
        let known = self.kinds.iter().position(|warning| warning.kind == kind);
        let known = known.unwrap_or_else(|| self.begin(problem, kind));
        let warning = &mut self.kinds[known];
        warning.count += 1;
        if warning.places.len() < MAX_EXAMPLES && !place.is_empty() {
            warning.places.push(place.to_owned());
        }
    }

    /// Takes over the warnings of another input.
    pub fn extend(&mut self, others: Self) {
        for other in others.kinds {
            match self.kinds.iter_mut().find(|warning| warning.kind == other.kind) {
                Some(warning) => warning.merge(other),
                None => self.kinds.push(other),
            }
        }
    }

    /// One warning per kind, in the order of their first occurrence.
    pub fn iter(&self) -> impl Iterator<Item = &Warning> {
        self.kinds.iter()
    }

    /// Whether the collection is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Number of warnings of all kinds.
    #[must_use]
    pub fn count(&self) -> usize {
        self.kinds.iter().map(|warning| warning.count).sum()
    }

    /// The index of a new kind, or of the last, which takes all others.
    fn begin(&mut self, problem: &str, kind: String) -> usize {
        if self.kinds.len() < MAX_KINDS {
            let (problem, kind) = if self.kinds.len() + 1 < MAX_KINDS {
                (problem.to_owned(), kind)
            } else {
                (OTHERS.to_owned(), OTHERS.to_owned())
            };
            self.kinds.push(Warning { problem, count: 0, places: Vec::new(), kind });
        }
        self.kinds.len() - 1
    }
}

impl Warning {
    /// Number of warnings of this kind.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    fn merge(&mut self, other: Self) {
        self.count += other.count;
        self.places.extend(other.places);
        self.places.truncate(MAX_EXAMPLES);
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { problem, count, places, .. } = self;
        f.write_str(problem)?;
        if *count > 1 {
            write!(f, ", {count} times")?;
        }
        if !places.is_empty() {
            let more = if places.len() < *count { ", ..." } else { "" };
            write!(f, ": {}{more}", places.join(", "))?;
        }
        Ok(())
    }
}

/// The text with each run of digits as one mark.
fn without_numbers(text: &str) -> String {
    let mut kind = String::with_capacity(text.len());
    for c in text.chars() {
        let is_number = c.is_ascii_digit() || (matches!(c, '.' | '-') && kind.ends_with('#'));
        match is_number {
            true if kind.ends_with('#') => {}
            true => kind.push('#'),
            false => kind.push(c),
        }
    }
    kind
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(warnings: &Warnings) -> Vec<String> {
        warnings.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_kind_is_one_line_with_its_count_and_three_places() {
        let mut warnings = Warnings::default();
        for i in 0..3000 {
            warnings.add(&format!("is {i}.5 px wide, expected 640"), &format!("{i}.png"));
        }
        warnings.add("does not exist", "rgb/7.png");
        assert_eq!(
            lines(&warnings),
            [
                "is 0.5 px wide, expected 640, 3000 times: 0.png, 1.png, 2.png, ...",
                "does not exist: rgb/7.png"
            ]
        );
        assert_eq!(warnings.count(), 3001);
    }

    #[test]
    fn however_many_kinds_there_are_the_lines_are_few_and_nothing_is_uncounted() {
        let mut warnings = Warnings::default();
        let word = |i: u8| char::from(b'a' + i % 26).to_string().repeat(usize::from(i / 26 + 1));
        (0..100).for_each(|i| warnings.add(&word(i), ""));
        assert_eq!((warnings.iter().count(), warnings.count()), (MAX_KINDS, 100));
        assert!(lines(&warnings).last().unwrap().starts_with("other problems, 85 times"));
    }

    #[test]
    fn collections_add_up() {
        let (mut a, mut b) = (Warnings::default(), Warnings::default());
        a.add("is broken", "line 1");
        (2..6).for_each(|i| b.add("is broken", &format!("line {i}")));
        a.extend(b);
        assert_eq!(lines(&a), ["is broken, 5 times: line 1, line 2, line 3, ..."]);
        assert!(Warnings::default().is_empty());
    }
}
