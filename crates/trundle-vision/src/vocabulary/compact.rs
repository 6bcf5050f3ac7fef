use super::Vocabulary;
use super::tree::ListedNode;
use crate::Descriptor;
use trundle_core::Invalid;

/// What a vocabulary's file begins with; the last byte is the version.
const MAGIC: &[u8; 8] = b"trundlV\x01";

/// Bytes of the head: magic, branching, depth, number of nodes, checksum.
const HEAD: usize = 8 + 4 + 4 + 4 + 8;

/// Bytes of a node: parent with the leaf's mark in its highest bit, descriptor, weight.
const NODE: usize = 4 + 32 + 4;

const LEAF: u32 = 1 << 31;

/// Why a vocabulary could not be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VocabularyError {
    /// A line of a text is not as it should be.
    #[error("line {number}: {problem}")]
    Line {
        /// From 1.
        number: usize,
        /// What is wrong.
        problem: String,
    },
    /// The bytes are no vocabulary of this version, or damaged.
    #[error("{0}")]
    Bytes(String),
    /// The nodes are no tree.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

impl Vocabulary {
    /// The vocabulary as bytes, versioned and with a checksum: 40 a node, little endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let body: Vec<u8> = self.nodes()[1..]
            .iter()
            .flat_map(|node| {
                let leaf = if node.children == 0 { LEAF } else { 0 };
                let words = node.descriptor.0.into_iter().flat_map(u64::to_le_bytes);
                (node.parent | leaf).to_le_bytes().into_iter().chain(words).chain(node.weight.to_le_bytes())
            })
            .collect();
        let mut bytes = MAGIC.to_vec();
        for number in [self.branching(), self.depth(), self.nodes().len() - 1] {
            bytes.extend((number as u32).to_le_bytes());
        }
        bytes.extend(checksum(&body).to_le_bytes());
        bytes.extend(body);
        bytes
    }

    /// Reads [`Vocabulary::to_bytes`].
    ///
    /// # Errors
    /// When the bytes are of another kind or version, cut off, damaged, or the nodes are no tree.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, VocabularyError> {
        let bad = |problem: String| Err(VocabularyError::Bytes(problem));
        if bytes.len() < HEAD || bytes[..7] != MAGIC[..7] {
            return bad("no trundle vocabulary".to_owned());
        }
        if bytes[7] != MAGIC[7] {
            return bad(format!("vocabulary of version {}, expected {}", bytes[7], MAGIC[7]));
        }
        let (branching, depth, count) = (word(bytes, 8), word(bytes, 12), word(bytes, 16) as usize);
        let body = &bytes[HEAD..];
        if body.len() != count.saturating_mul(NODE) {
            return bad(format!(
                "vocabulary of {} bytes, expected {} for {count} nodes",
                bytes.len(),
                HEAD + count.saturating_mul(NODE)
            ));
        }
        if checksum(body) != long(bytes, 20) {
            return bad("the vocabulary is damaged: its checksum is wrong".to_owned());
        }
        let list: Vec<ListedNode> = body.chunks_exact(NODE).map(node).collect();
        Ok(Self::from_list(branching as usize, depth as usize, &list)?)
    }
}

fn node(bytes: &[u8]) -> ListedNode {
    let head = word(bytes, 0);
    ListedNode {
        parent: head & !LEAF,
        is_leaf: head & LEAF != 0,
        descriptor: Descriptor(std::array::from_fn(|i| long(bytes, 4 + 8 * i))),
        weight: f32::from_bits(word(bytes, 36)),
    }
}

fn word(bytes: &[u8], at: usize) -> u32 {
    bytes[at..at + 4].iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

fn long(bytes: &[u8], at: usize) -> u64 {
    bytes[at..at + 8].iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte))
}

/// FNV-1a over 8 bytes at a time, the last ones filled with zeros.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.chunks(8).fold(0xCBF2_9CE4_8422_2325, |sum, chunk| {
        let word = chunk.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        (sum ^ word).wrapping_mul(0x0100_0000_01B3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vocabulary::VocabularyConfig;

    fn trained() -> Vocabulary {
        let images: Vec<Vec<Descriptor>> = (0..6_u64)
            .map(|n| (0..50).map(|i| Descriptor([n * 7919 + i * i, i << 40, !n, i * 31])).collect())
            .collect();
        Vocabulary::train(&images, &VocabularyConfig { branching: 3, depth: 4, least_to_divide: 4 }, 2)
            .unwrap()
    }

    #[test]
    fn bytes_read_back_and_damage_is_told() {
        let bytes = trained().to_bytes();
        assert_eq!(Vocabulary::from_bytes(&bytes).unwrap(), trained());
        let refused = |bytes: &[u8]| Vocabulary::from_bytes(bytes).unwrap_err().to_string();
        assert_eq!(refused(b"ORBvoc"), "no trundle vocabulary");
        assert!(refused(&bytes[..bytes.len() - 1]).contains("bytes, expected"));
        let changed = |at: usize| {
            let mut bytes = bytes.clone();
            bytes[at] ^= 4;
            refused(&bytes)
        };
        assert_eq!(changed(7), "vocabulary of version 5, expected 1");
        for at in (HEAD..bytes.len()).step_by(13) {
            assert_eq!(changed(at), "the vocabulary is damaged: its checksum is wrong");
        }
    }
}
