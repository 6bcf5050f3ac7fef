//! Changes to an input: bits, bytes, lengths, words, pieces of others, cuts.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Changes to one input, at most. Source: ours.
const MAX_CHANGES: usize = 6;
/// Longest input \[bytes\]. Source: ours.
const MAX_LENGTH: usize = 1 << 18;
/// Longest piece that is copied or cut \[bytes\]. Source: ours.
const MAX_PIECE: usize = 256;
/// Extreme values of lengths and counts. Source: ours.
const EDGES: [u64; 14] = [
    0,
    1,
    0x7f,
    0x80,
    0xff,
    0x7fff,
    0x8000,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    1 << 40,
    i64::MAX as u64,
    u64::MAX,
];

/// An input made from `parent` by some changes.
pub fn mutate(parent: &[u8], other: &[u8], words: &[&str], rng: &mut ChaCha8Rng) -> Vec<u8> {
    let mut input = parent.to_vec();
    for _ in 0..rng.random_range(1..=MAX_CHANGES) {
        change(&mut input, other, words, rng);
    }
    input.truncate(MAX_LENGTH);
    input
}

fn change(input: &mut Vec<u8>, other: &[u8], words: &[&str], rng: &mut ChaCha8Rng) {
    let at = rng.random_range(0..=input.len());
    match rng.random_range(0..11) {
        0 => flip_bit(input, at, rng),
        1 => set_byte(input, at, rng.random()),
        2 => overwrite(input, at, &edge(rng)),
        3 => overwrite(input, at, &small_step(input, at, rng)),
        4 => drop(input.drain(at..(at + piece(rng)).min(input.len()))),
        5 => insert(input, at, &copy_of(&input.clone(), rng)),
        6 => insert(input, at, &copy_of(other, rng)),
        7 => overwrite(input, at, &copy_of(other, rng)),
        8 if rng.random_range(0..4) == 0 => input.truncate(at),
        9 => change_digit(input, at, rng),
        _ if words.is_empty() => flip_bit(input, at, rng),
        _ => insert(input, at, words[rng.random_range(0..words.len())].as_bytes()),
    }
}

fn flip_bit(input: &mut [u8], at: usize, rng: &mut ChaCha8Rng) {
    if let Some(byte) = input.get_mut(at) {
        *byte ^= 1 << rng.random_range(0..8);
    }
}

fn set_byte(input: &mut [u8], at: usize, value: u8) {
    if let Some(byte) = input.get_mut(at) {
        *byte = value;
    }
}

/// An extreme number of 1 to 8 bytes, in either byte order.
fn edge(rng: &mut ChaCha8Rng) -> Vec<u8> {
    let bytes = EDGES[rng.random_range(0..EDGES.len())].to_le_bytes();
    let mut bytes = bytes[..1 << rng.random_range(0..4)].to_vec();
    if rng.random() {
        bytes.reverse();
    }
    bytes
}

/// The four bytes at a place as a number, changed by a little.
fn small_step(input: &[u8], at: usize, rng: &mut ChaCha8Rng) -> Vec<u8> {
    let Some(bytes) = input.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()) else {
        return Vec::new();
    };
    let step = rng.random_range(0..33_u32).wrapping_sub(16);
    if rng.random() {
        u32::from_le_bytes(bytes).wrapping_add(step).to_le_bytes().to_vec()
    } else {
        u32::from_be_bytes(bytes).wrapping_add(step).to_be_bytes().to_vec()
    }
}

/// A digit at or behind a place becomes another, or many.
fn change_digit(input: &mut Vec<u8>, at: usize, rng: &mut ChaCha8Rng) {
    let Some(digit) = (at..input.len()).find(|&i| input[i].is_ascii_digit()) else { return };
    input[digit] = b'0' + rng.random_range(0..10);
    if rng.random_range(0..8) == 0 {
        insert(input, digit, &[b'9'; 12]);
    }
}

fn piece(rng: &mut ChaCha8Rng) -> usize {
    let max = [4, 32, MAX_PIECE][rng.random_range(0..3)];
    rng.random_range(1..=max)
}

fn copy_of(source: &[u8], rng: &mut ChaCha8Rng) -> Vec<u8> {
    let from = rng.random_range(0..=source.len());
    source[from..(from + piece(rng)).min(source.len())].to_vec()
}

fn insert(input: &mut Vec<u8>, at: usize, bytes: &[u8]) {
    input.splice(at..at, bytes.iter().copied());
}

fn overwrite(input: &mut Vec<u8>, at: usize, bytes: &[u8]) {
    let end = (at + bytes.len()).min(input.len());
    input.splice(at..end, bytes.iter().copied());
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn the_same_seed_makes_the_same_inputs_and_they_differ() {
        let inputs = |seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            (0..500).map(|_| mutate(b"width: 12", b"P5 4 3", &["nan"], &mut rng)).collect::<Vec<_>>()
        };
        assert_eq!(inputs(1), inputs(1));
        let mut distinct = inputs(1);
        distinct.sort();
        distinct.dedup();
        assert!(distinct.len() > 400, "{}", distinct.len());
    }
}
