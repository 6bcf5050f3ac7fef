//! The weighted words of an image.

use super::node_id::NodeId;

/// The words of an image with their weights: term frequency times inverse document frequency, L1 norm 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BagOfWords {
    /// Entries by rising word.
    entries: Vec<(NodeId, f32)>,
}

impl BagOfWords {
    /// The bag of `words`, with repetitions; words of every image (weight 0) are ignored.
    pub(super) fn new(words: &[NodeId], weight: impl Fn(NodeId) -> f32) -> Self {
        let mut sorted = words.to_vec();
        sorted.sort_unstable();
        let runs = sorted.chunk_by(|a, b| a == b);
        let weighted = runs.map(|run| (run[0], run.len() as f32 * weight(run[0])));
        let mut entries: Vec<(NodeId, f32)> = weighted.filter(|(_, weight)| *weight > 0.0).collect();
        let sum: f32 = entries.iter().map(|(_, weight)| weight).sum();
        entries.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Self { entries }
    }

    /// The words by rising number, with their weights, which sum to 1.
    pub fn entries(&self) -> &[(NodeId, f32)] {
        &self.entries
    }

    /// Whether the bag has no word.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// 1 - |v - w|_1 / 2, 0 to 1 \[GalvezLopez12, eq. 1\]: the sum over common words of the lesser weight.
    pub fn similarity(&self, other: &Self) -> f32 {
        let (mut a, mut b) = (self.entries.iter().peekable(), other.entries.iter().peekable());
        let mut sum = 0.0;
        while let (Some(&&(i, v)), Some(&&(j, w))) = (a.peek(), b.peek()) {
            if i == j {
                sum += v.min(w);
            }
            if i <= j {
                a.next();
            }
            if j <= i {
                b.next();
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bag(words: &[NodeId]) -> BagOfWords {
        BagOfWords::new(words, |word| if word == 9 { 0.0 } else { word as f32 })
    }

    #[test]
    fn weights_are_frequency_times_rarity_and_sum_to_one() {
        assert_eq!(bag(&[3, 1, 9, 1, 3, 3]).entries(), [(1, 2.0 / 11.0), (3, 9.0 / 11.0)]);
        assert!(bag(&[9, 9]).is_empty());
        assert_eq!(bag(&[]).similarity(&bag(&[1])), 0.0);
    }

    proptest! {
        #[test]
        fn similarity_is_one_less_half_the_l1_distance(
            a in prop::collection::vec(1..9u32, 1..20), b in prop::collection::vec(1..9u32, 1..20),
        ) {
            let (a, b) = (bag(&a), bag(&b));
            let weight = |bag: &BagOfWords, word| bag.entries().iter().find(|e| e.0 == word).map_or(0.0, |e| e.1);
            let distance: f32 = (1..9).map(|word| (weight(&a, word) - weight(&b, word)).abs()).sum();
            prop_assert!((a.similarity(&b) - (1.0 - distance / 2.0)).abs() < 1e-5);
            prop_assert_eq!(a.similarity(&b), b.similarity(&a));
            prop_assert!((a.similarity(&a) - 1.0).abs() < 1e-5);
        }
    }
}
