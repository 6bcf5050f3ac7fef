//! The binary file of a vocabulary.

use super::Vocabulary;
use super::listed::{check_shape, check_weight};
use super::tree::Tree;
use crate::Descriptor;
use trundle_core::Invalid;

/// First bytes of a vocabulary's file; the last byte is the version.
const MAGIC: &[u8; 8] = b"trundlV\x02";

/// Bytes of the head: magic, branching, depth, nodes, words, checksum of all but magic and checksum.
const HEAD_BYTES: usize = 8 + 4 * 4 + 8;

/// Reason why a vocabulary could not be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VocabularyError {
    /// A line of a text is invalid.
    #[error("line {number}: {problem}")]
    Line {
        /// Number of the line, from 1.
        number: usize,
        /// The problem.
        problem: String,
    },
    /// The bytes are not a vocabulary of this version, or damaged.
    #[error("{0}")]
    Bytes(String),
    /// The nodes are not a tree.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// See [`Vocabulary::to_bytes`].
pub(super) fn to_bytes(vocabulary: &Vocabulary) -> Vec<u8> {
    let words = vocabulary.nodes().filter(|node| vocabulary.is_word(*node));
    let weights: Vec<f32> = words.map(|word| vocabulary.weight(word)).collect();
    let shape = [vocabulary.branching(), vocabulary.depth(), vocabulary.nodes().len(), weights.len()];
    let mut bytes = MAGIC.to_vec();
    bytes.extend(shape.into_iter().flat_map(|number| (number as u32).to_le_bytes()));
    bytes.extend([0; 8]);
    let longs = vocabulary.nodes().flat_map(|node| vocabulary.descriptor(node).0);
    bytes.extend(longs.flat_map(u64::to_le_bytes));
    bytes.push(vocabulary.children(0) as u8);
    bytes.extend(vocabulary.nodes().map(|node| vocabulary.children(node) as u8));
    bytes.extend(weights.into_iter().flat_map(f32::to_le_bytes));
    let sum = checksum(&bytes);
    bytes[HEAD_BYTES - 8..HEAD_BYTES].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// See [`Vocabulary::from_bytes`].
pub(super) fn from_bytes(bytes: &[u8]) -> Result<Vocabulary, VocabularyError> {
    let bad = |problem: String| Err(VocabularyError::Bytes(problem));
    if bytes.len() < HEAD_BYTES || bytes[..7] != MAGIC[..7] {
        return bad("no trundle vocabulary".to_owned());
    }
    if bytes[7] != MAGIC[7] {
        return bad(format!("vocabulary of version {}, expected {}", bytes[7], MAGIC[7]));
    }
    let [branching, depth, nodes, words] = std::array::from_fn(|i| number(&bytes[8 + 4 * i..]) as usize);
    let expected =
        (HEAD_BYTES + 1).saturating_add(nodes.saturating_mul(33)).saturating_add(words.saturating_mul(4));
    if bytes.len() != expected {
        return bad(format!("vocabulary of {} bytes, expected {expected} for {nodes} nodes", bytes.len()));
    }
    if checksum(bytes).to_le_bytes() != bytes[HEAD_BYTES - 8..HEAD_BYTES] {
        return bad("the vocabulary is damaged: its checksum is wrong".to_owned());
    }
    check_shape(branching, depth)?;
    Ok(Vocabulary::from_tree(branching, depth, tree(&bytes[HEAD_BYTES..], nodes, branching)?)?)
}

/// The nodes of a file without its head.
fn tree(body: &[u8], nodes: usize, branching: usize) -> Result<Tree, Invalid> {
    let (descriptors, rest) = body.split_at(32 * nodes);
    let (counts, weights) = rest.split_at(nodes + 1);
    if let Some((node, count)) = counts.iter().enumerate().find(|(_, count)| usize::from(**count) > branching)
    {
        let name = format!("children of vocabulary node {node}");
        return Err(Invalid::new(name, count, "", format!("{branching} or fewer")));
    }
    let mut weights = weights.chunks_exact(4).map(|bytes| f32::from_bits(number(bytes)));
    let mut weight = |(node, count): (usize, &u8)| {
        let weight = if *count == 0 { weights.next().unwrap_or(f32::NAN) } else { 0.0 };
        check_weight(weight, node).map(|()| weight)
    };
    let weights = counts.iter().enumerate().skip(1).map(&mut weight).collect::<Result<_, _>>()?;
    let descriptor = |bytes: &[u8]| Descriptor(std::array::from_fn(|i| long(&bytes[8 * i..])));
    let descriptors = descriptors.chunks_exact(32).map(descriptor).collect();
    Ok(Tree { descriptors, weights, counts: counts.to_vec() })
}

/// The number in the first four bytes.
fn number(bytes: &[u8]) -> u32 {
    u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
}

/// The number in the first eight bytes.
fn long(bytes: &[u8]) -> u64 {
    u64::from(number(bytes)) | u64::from(number(&bytes[4..])) << 32
}

/// FNV-1a in steps of 8 bytes over the numbers of the head and all following bytes; the last step is padded with zeros.
fn checksum(bytes: &[u8]) -> u64 {
    let (head, body) = (&bytes[8..HEAD_BYTES - 8], &bytes[HEAD_BYTES..]);
    let whole = body.chunks_exact(8);
    let mut last = [0; 8];
    last[..whole.remainder().len()].copy_from_slice(whole.remainder());
    let longs = head.chunks_exact(8).chain(whole).chain([&last[..]]).map(long);
    longs.fold(0xCBF2_9CE4_8422_2325, |sum, long| (sum ^ long).wrapping_mul(0x0100_0000_01B3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vocabulary::VocabularyConfig;

    fn trained() -> Vocabulary {
        let images: Vec<Vec<Descriptor>> = (0..6_u64)
            .map(|n| (0..50).map(|i| Descriptor([n * 7919 + i * i, i << 40, !n, i * 31])).collect())
            .collect();
        Vocabulary::train(&images, &VocabularyConfig { branching: 3, depth: 4, min_to_divide: 4 }, 2).unwrap()
    }

    fn refused(bytes: &[u8]) -> String {
        Vocabulary::from_bytes(bytes).unwrap_err().to_string()
    }

    #[test]
    fn bytes_read_back_and_damage_is_reported() {
        let bytes = trained().to_bytes();
        assert_eq!(Vocabulary::from_bytes(&bytes).unwrap(), trained());
        assert_eq!(refused(b"ORBvoc"), "no trundle vocabulary");
        assert!(refused(&bytes[..bytes.len() - 1]).contains("bytes, expected"));
        let changed = |at: usize| {
            let mut bytes = bytes.clone();
            bytes[at] ^= 4;
            refused(&bytes)
        };
        assert_eq!(changed(7), "vocabulary of version 6, expected 2");
        for at in (8..16).chain(HEAD_BYTES - 8..bytes.len()) {
            assert_eq!(changed(at), "the vocabulary is damaged: its checksum is wrong", "byte {at}");
        }
    }

    #[test]
    fn a_broken_tree_is_refused_even_with_a_right_checksum() {
        let forged = |at: usize, value: u8| {
            let mut bytes = trained().to_bytes();
            bytes[at] = value;
            let sum = checksum(&bytes);
            bytes[HEAD_BYTES - 8..HEAD_BYTES].copy_from_slice(&sum.to_le_bytes());
            refused(&bytes)
        };
        let counts = HEAD_BYTES + 32 * trained().nodes().len();
        assert_eq!(forged(8, 200), "branching of the vocabulary is 200, expected 2 to 64");
        assert_eq!(forged(12, 0), "depth of the vocabulary is 0, expected 1 to 10");
        assert_eq!(forged(counts + 2, 9), "children of vocabulary node 2 is 9, expected 3 or fewer");
        assert!(forged(counts, 1).starts_with("children of all vocabulary nodes"), "{}", forged(counts, 1));
        let last = trained().to_bytes().len() - 1;
        assert!(forged(last, 0xFF).starts_with("weight of vocabulary node"), "{}", forged(last, 0xFF));
    }
}
