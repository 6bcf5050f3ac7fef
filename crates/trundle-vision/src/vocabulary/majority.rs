//! The bitwise median of descriptors.

use crate::Descriptor;

/// For each of the 256 bits, the number of descriptors of a set with this bit, for the bitwise median.
#[derive(Debug, Clone)]
pub(super) struct BitCounts {
    /// A byte for each bit, eight to a word: counts since the last flush.
    small: [u64; 32],
    unflushed: u32,
    ones: [u32; 256],
    count: u32,
}

/// The bits of a byte as eight bytes of 0 or 1, the lowest first.
const BYTE_OF_BITS: [u64; 256] = {
    let mut table = [0; 256];
    let mut at = 0;
    while at < 256 * 8 {
        let (byte, bit) = (at / 8, at % 8);
        table[byte] |= (((byte >> bit) & 1) as u64) << (8 * bit);
        at += 1;
    }
    table
};

impl BitCounts {
    /// The counts without a descriptor.
    pub fn new() -> Self {
        Self { small: [0; 32], unflushed: 0, ones: [0; 256], count: 0 }
    }

    /// Counts one more.
    pub fn add(&mut self, descriptor: &Descriptor) {
        for (small, word) in self.small.chunks_exact_mut(8).zip(descriptor.0) {
            for (small, byte) in small.iter_mut().zip(word.to_le_bytes()) {
                *small += BYTE_OF_BITS[usize::from(byte)];
            }
        }
        self.count += 1;
        self.unflushed += 1;
        if self.unflushed == u32::from(u8::MAX) {
            self.flush();
        }
    }

    /// Each bit by majority, 1 for a tie; `None` without descriptors.
    pub fn median(mut self) -> Option<Descriptor> {
        self.flush();
        let bit = |i: usize| u64::from(2 * self.ones[i] >= self.count);
        let word = |word: usize| (0..64).fold(0, |bits, i| bits | bit(64 * word + i) << i);
        (self.count > 0).then(|| Descriptor(std::array::from_fn(word)))
    }

    fn flush(&mut self) {
        for (ones, small) in self.ones.chunks_exact_mut(8).zip(&mut self.small) {
            for (ones, byte) in ones.iter_mut().zip(small.to_le_bytes()) {
                *ones += u32::from(byte);
            }
            *small = 0;
        }
        self.unflushed = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_median_is_the_majority_of_each_bit(
            words in prop::collection::vec(prop::array::uniform4(any::<u64>()), 1..5), repeats in 1..200_usize,
        ) {
            let descriptors: Vec<Descriptor> = words.into_iter().map(Descriptor).collect();
            let all = || descriptors.iter().cycle().take(descriptors.len() * repeats + 1);
            let mut counts = BitCounts::new();
            all().for_each(|descriptor| counts.add(descriptor));
            let median = counts.median().unwrap();
            for bit in 0..256 {
                let has = |d: &Descriptor| d.0[bit / 64] >> (bit % 64) & 1 == 1;
                let ones = all().filter(|d| has(d)).count();
                prop_assert_eq!(has(&median), 2 * ones >= all().count(), "bit {}", bit);
            }
        }
    }

    #[test]
    fn an_empty_set_has_no_median() {
        assert_eq!(BitCounts::new().median(), None);
    }
}
