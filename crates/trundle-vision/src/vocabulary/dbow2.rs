//! The text file of DBoW2.

use super::Vocabulary;
use super::compact::VocabularyError;
use super::listed::{ListedNode, from_list};
use crate::Descriptor;
use std::fmt::Write;

/// See [`Vocabulary::to_dbow2_text`].
pub(super) fn to_text(vocabulary: &Vocabulary) -> String {
    let mut text = format!("{} {} 0 0", vocabulary.branching(), vocabulary.depth());
    for node in vocabulary.nodes() {
        write!(text, "\n{} {}", vocabulary.parent(node), u8::from(vocabulary.is_word(node)))
            .expect("invariant: strings grow");
        for byte in vocabulary.descriptor(node).0.iter().flat_map(|word| word.to_le_bytes()) {
            write!(text, " {byte}").expect("invariant: strings grow");
        }
        write!(text, " {}", vocabulary.weight(node)).expect("invariant: strings grow");
    }
    text
}

/// See [`Vocabulary::from_dbow2_text`].
pub(super) fn from_text(text: &str) -> Result<Vocabulary, VocabularyError> {
    let mut lines = (1..).zip(text.lines());
    let (_, head) = lines.next().ok_or_else(|| bad_line(1, "the file is empty"))?;
    let shape = numbers::<usize>(head, 1)?;
    let [branching, depth, ..] = shape[..] else {
        return Err(bad_line(1, "expected 'branching depth scoring weighting'"));
    };
    let rest = lines.filter(|(_, line)| !line.trim().is_empty());
    let list: Vec<ListedNode> = rest.map(|(number, line)| node(line, number)).collect::<Result<_, _>>()?;
    Ok(from_list(branching, depth, &list)?)
}

fn node(line: &str, number: usize) -> Result<ListedNode, VocabularyError> {
    let mut fields = line.split_whitespace();
    let mut field =
        || fields.next().ok_or_else(|| bad_line(number, "expected 'parent is_leaf 32 bytes weight'"));
    let (parent, is_leaf) = (one(field()?, number)?, one::<u8>(field()?, number)? != 0);
    let mut words = [0; 4];
    for i in 0..32 {
        words[i / 8] |= u64::from(one::<u8>(field()?, number)?) << (8 * (i % 8));
    }
    let weight = one(field()?, number)?;
    match fields.next() {
        Some(more) => Err(bad_line(number, &format!("'{more}' after 'parent is_leaf 32 bytes weight'"))),
        None => Ok(ListedNode { parent, is_leaf, descriptor: Descriptor(words), weight }),
    }
}

fn numbers<T: std::str::FromStr>(line: &str, number: usize) -> Result<Vec<T>, VocabularyError> {
    line.split_whitespace().map(|field| one(field, number)).collect()
}

fn one<T: std::str::FromStr>(field: &str, number: usize) -> Result<T, VocabularyError> {
    field.parse().map_err(|_| bad_line(number, &format!("'{field}' is not a number of its kind")))
}

fn bad_line(number: usize, problem: &str) -> VocabularyError {
    VocabularyError::Line { number, problem: problem.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vocabulary::VocabularyConfig;

    pub(crate) fn trained() -> Vocabulary {
        let feature =
            |i: u64| Descriptor(std::array::from_fn(|k| (i + k as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        let images: Vec<Vec<Descriptor>> =
            (0..8).map(|n| (n * 40..n * 40 + 90).map(feature).collect()).collect();
        let config = VocabularyConfig { branching: 4, depth: 3, ..VocabularyConfig::default() };
        Vocabulary::train(&images, &config, 5).unwrap()
    }

    #[test]
    fn a_written_vocabulary_reads_back_to_the_last_bit() {
        let text = trained().to_dbow2_text();
        assert!(text.starts_with("4 3 0 0\n0 0 "));
        assert!(!text.ends_with('\n'));
        assert_eq!(Vocabulary::from_dbow2_text(&text).unwrap(), trained());
        assert_eq!(Vocabulary::from_dbow2_text(&(text + "\n\n")).unwrap(), trained());
    }

    #[test]
    fn broken_lines_are_named() {
        let text = trained().to_dbow2_text();
        let refused = |text: &str| Vocabulary::from_dbow2_text(text).unwrap_err().to_string();
        assert_eq!(refused(""), "line 1: the file is empty");
        assert_eq!(refused("4 x"), "line 1: 'x' is not a number of its kind");
        assert_eq!(refused("4"), "line 1: expected 'branching depth scoring weighting'");
        assert_eq!(refused("4 3 0 0\n0 1 7 5"), "line 2: expected 'parent is_leaf 32 bytes weight'");
        let cut = &text[..text.len() - 40];
        assert!(refused(cut).contains("expected 'parent is_leaf 32 bytes weight'"), "{}", refused(cut));
        let long = text.replacen("\n", " 0 0\n", 2);
        assert_eq!(refused(&long), "line 2: '0' after 'parent is_leaf 32 bytes weight'");
        let odd = text.replacen("\n0 0 ", "\n7 0 ", 1);
        assert_eq!(refused(&odd), "parent of vocabulary node 1 is 7, expected an inner node before it");
    }
}
