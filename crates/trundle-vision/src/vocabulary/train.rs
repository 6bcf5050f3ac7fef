//! Trains a vocabulary.

use super::clusters::{Cluster, clusters};
use super::listed::{ListedNode, from_list};
use super::tree::{MAX_BRANCHING, MAX_DEPTH};
use super::{NodeId, Vocabulary};
use crate::Descriptor;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// The shape of a vocabulary to train.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct VocabularyConfig {
    /// Children of a node, 2 to 64. Default 10 \[GalvezLopez12\].
    pub branching: usize,
    /// Levels below the root, 1 to 10. Default 5: at most 100,000 words, the most that fit the program with room to spare.
    pub depth: usize,
    /// A node of fewer descriptors than this is not divided, 2 or more. Default 10: a word that a few features made is
    /// noise.
    pub min_to_divide: usize,
}

impl Default for VocabularyConfig {
    fn default() -> Self {
        Self { branching: 10, depth: 5, min_to_divide: 10 }
    }
}

impl VocabularyConfig {
    /// The shape with this number of children of a node and of levels below the root.
    pub fn of_tree(branching: usize, depth: usize) -> Self {
        Self { branching, depth, ..Self::default() }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("vocabulary.branching", self.branching as f64, "", 2.0, MAX_BRANCHING as f64)?;
        require_in("vocabulary.depth", self.depth as f64, "", 1.0, MAX_DEPTH as f64)?;
        require_in("vocabulary.min_to_divide", self.min_to_divide as f64, "", 2.0, 1e9)?;
        Ok(self)
    }
}

/// See [`Vocabulary::train`].
pub(super) fn train(
    images: &[Vec<Descriptor>],
    config: &VocabularyConfig,
    seed: u64,
) -> Result<Vocabulary, Invalid> {
    let config = config.clone().validated()?;
    let descriptors: Vec<Descriptor> = images.iter().flatten().copied().collect();
    if descriptors.is_empty() {
        return Err(Invalid::new("descriptors to train on", 0, "", "1 or more"));
    }
    let root = divide(&descriptors, &config, 0, seed);
    let mut list = Vec::new();
    list_below(&root, 0, &mut list);
    let mut vocabulary = from_list(config.branching, config.depth, &list)?;
    weigh(&mut vocabulary, images);
    Ok(vocabulary)
}

/// Weighs the words by the number of images that show them.
fn weigh(vocabulary: &mut Vocabulary, images: &[Vec<Descriptor>]) {
    let words_of = |image: &Vec<Descriptor>| {
        let mut words: Vec<NodeId> = image.iter().map(|descriptor| vocabulary.word(descriptor)).collect();
        words.sort_unstable();
        words.dedup();
        words
    };
    let words: Vec<Vec<NodeId>> = images.par_iter().map(words_of).collect();
    let mut images_with = vec![0_u32; vocabulary.nodes().len() + 1];
    words.iter().flatten().for_each(|&word| images_with[word as usize] += 1);
    let is_word: Vec<bool> = vocabulary.nodes().map(|node| vocabulary.is_word(node)).collect();
    for (word, _) in (1..).zip(is_word).filter(|(_, is_word)| *is_word) {
        let count = images_with[word as usize].max(1);
        vocabulary.set_weight(word, (images.len() as f32 / count as f32).ln());
    }
}

/// A part of the tree: a median and its subdivision.
struct Branch {
    median: Descriptor,
    below: Vec<Branch>,
}

/// The children of a node at `level` with these members; each child has its own seed.
fn divide(descriptors: &[Descriptor], config: &VocabularyConfig, level: usize, seed: u64) -> Vec<Branch> {
    let is_done = level == config.depth || (level > 0 && descriptors.len() < config.min_to_divide);
    if is_done {
        return Vec::new();
    }
    let found = clusters(descriptors, config.branching, &mut ChaCha8Rng::seed_from_u64(seed));
    if level > 0 && found.len() < 2 {
        return Vec::new();
    }
    let branch = |(i, cluster): (usize, Cluster)| {
        let seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(i as u64 + 1);
        Branch { median: cluster.median, below: divide(&cluster.members, config, level + 1, seed) }
    };
    found.into_par_iter().enumerate().map(branch).collect()
}

fn list_below(branches: &[Branch], parent: NodeId, list: &mut Vec<ListedNode>) {
    for branch in branches {
        let is_leaf = branch.below.is_empty();
        list.push(ListedNode { parent, is_leaf, descriptor: branch.median, weight: 0.0 });
        let id = list.len() as NodeId;
        list_below(&branch.below, id, list);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    /// Images of `places` places, `views` of each place, with a few bits of every feature changed.
    fn images(places: u64, views: u64) -> Vec<Vec<Descriptor>> {
        let view = |place: u64, view: u64| {
            let (mut scene, mut noise) =
                (ChaCha8Rng::seed_from_u64(place), ChaCha8Rng::seed_from_u64(1000 + place * 99 + view));
            let mut feature = || {
                let mut d = Descriptor(std::array::from_fn(|_| scene.random()));
                (0..12).for_each(|_| d.0[noise.random_range(0..4)] ^= 1 << noise.random_range(0..64));
                d
            };
            (0..120).map(|_| feature()).collect()
        };
        (0..places).flat_map(|place| (0..views).map(move |v| (place, v))).map(|(p, v)| view(p, v)).collect()
    }

    #[test]
    fn a_place_seen_again_is_the_most_similar_of_all() {
        let config = VocabularyConfig { branching: 8, depth: 3, ..VocabularyConfig::default() };
        let vocabulary = Vocabulary::train(&images(20, 3), &config, 7).unwrap();
        let seen = images(20, 5);
        let bag = |place: usize, view: usize| vocabulary.describe(&seen[place * 5 + view]).0;
        for place in 0..20 {
            let asked = bag(place, 4);
            let similar = |other: &usize| asked.similarity(&bag(*other, 3));
            let best = (0..20).max_by(|a, b| similar(a).total_cmp(&similar(b)));
            assert_eq!(best, Some(place));
        }
    }

    #[test]
    fn words_weigh_their_inverse_frequency_and_never_infinitely() {
        let images = images(12, 2);
        let vocabulary = Vocabulary::train(&images, &VocabularyConfig::default(), 3).unwrap();
        for word in vocabulary.nodes().filter(|node| vocabulary.is_word(*node)) {
            let shows = |image: &&Vec<Descriptor>| image.iter().any(|d| vocabulary.word(d) == word);
            let showing = images.iter().filter(shows).count().max(1);
            assert_eq!(vocabulary.weight(word), (24.0 / showing as f32).ln());
        }
    }

    #[test]
    fn training_is_the_same_on_any_number_of_threads_and_refuses_nothing() {
        let train = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Vocabulary::train(&images(6, 2), &VocabularyConfig::default(), 3).unwrap())
        };
        assert_eq!(train(1), train(3));
        let error = Vocabulary::train(&[Vec::new()], &VocabularyConfig::default(), 3).unwrap_err();
        assert_eq!(error.field, "descriptors to train on");
        let flat = VocabularyConfig { depth: 0, ..VocabularyConfig::default() };
        assert_eq!(Vocabulary::train(&images(1, 1), &flat, 3).unwrap_err().field, "vocabulary.depth");
    }
}
