//! Files saved by trundle: each is read unchanged, and with a corrected checksum.

use crate::seeds::small_camera;
use trundle::runtime::Checkpoint;
use trundle::slam::{RgbdSlam, SlamConfig};
use trundle::vision::Vocabulary;

/// The maps of visual SLAM.
pub fn visual_map(bytes: &[u8]) {
    for bytes in [bytes.to_vec(), with_checksum(bytes, 8..16, |bytes| word_sum(&bytes[16..]))] {
        let _ = RgbdSlam::load(&bytes, small_camera(), SlamConfig::default());
    }
}

/// A vocabulary in trundle's form.
pub fn vocabulary(bytes: &[u8]) {
    for bytes in [bytes.to_vec(), with_checksum(bytes, 24..32, vocabulary_sum)] {
        let _ = Vocabulary::from_bytes(&bytes);
    }
}

/// A vocabulary in the text form of DBoW2.
pub fn dbow2(bytes: &[u8]) {
    let _ = std::str::from_utf8(bytes).map(Vocabulary::from_dbow2_text);
}

/// A checkpoint.
pub fn checkpoint(bytes: &[u8]) {
    let sum = |bytes: &[u8]| u64::from(crc32fast::hash(&bytes[16..]));
    for bytes in [bytes.to_vec(), with_checksum(bytes, 12..16, sum)] {
        let Ok(checkpoint) = Checkpoint::from_bytes(&bytes) else { continue };
        let _ = RgbdSlam::load(&checkpoint.visual, small_camera(), SlamConfig::default());
    }
}

/// The bytes with the checksum at `at` set right, little endian; the bytes themselves if they are too short.
fn with_checksum(bytes: &[u8], at: std::ops::Range<usize>, sum: impl Fn(&[u8]) -> u64) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if bytes.len() >= at.end {
        let sum = sum(&bytes).to_le_bytes();
        let width = at.len();
        bytes[at].copy_from_slice(&sum[..width]);
    }
    bytes
}

/// The checksum of a visual map.
fn word_sum(bytes: &[u8]) -> u64 {
    bytes.chunks(8).fold(0xCBF2_9CE4_8422_2325 ^ bytes.len() as u64, |sum, chunk| {
        let word = chunk.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        (sum ^ word).wrapping_mul(0x0100_0000_01B3)
    })
}

/// The checksum of a vocabulary.
fn vocabulary_sum(bytes: &[u8]) -> u64 {
    let long = |chunk: &[u8]| chunk.iter().rev().fold(0, |long, byte| long << 8 | u64::from(*byte));
    let (head, body) = (&bytes[8..24], &bytes[32..]);
    let whole = body.chunks_exact(8);
    let last = long(whole.remainder());
    let longs = head.chunks_exact(8).chain(whole).map(long).chain([last]);
    longs.fold(0xCBF2_9CE4_8422_2325, |sum, long| (sum ^ long).wrapping_mul(0x0100_0000_01B3))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeds;

    #[test]
    fn the_checksums_are_those_of_the_files() {
        for (bytes, at, sum) in [
            (seeds::visual_map(), 8..16, (|b: &[u8]| word_sum(&b[16..])) as fn(&[u8]) -> u64),
            (seeds::vocabulary(), 24..32, vocabulary_sum),
        ] {
            assert_eq!(with_checksum(&bytes[0], at, sum), bytes[0]);
        }
    }
}
