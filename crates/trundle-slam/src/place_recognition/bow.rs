//! The bag of words of a frame, and matching under the nodes of the vocabulary.

use crate::frame::rgbd_frame::Frame;
use crate::matching::projection_search::MatchThresholds;
use trundle_vision::{BagOfWords, Match, NodeId, Vocabulary, match_mutual};

/// Level of the vocabulary at whose nodes features of two images are compared: 1. With ten children per node, a tenth of all pairs is
/// compared, and few correct pairs are missed. \[MurArtal17\] compares a hundredth. Source: ours.
const MATCHING_LEVEL: usize = 1;

/// The bag of words of a frame.
#[derive(Debug, Clone)]
pub(crate) struct Bow {
    pub bag: BagOfWords,
    /// Node at the matching level and feature, rising: the direct index.
    features: Vec<(NodeId, u32)>,
}

impl Bow {
    pub fn of(frame: &Frame, vocabulary: &Vocabulary) -> Self {
        let (bag, words) = vocabulary.describe(&frame.features.descriptors);
        let node = |word: NodeId| vocabulary.node_of(word, MATCHING_LEVEL);
        let mut features: Vec<(NodeId, u32)> = words.into_iter().map(node).zip(0..).collect();
        features.sort_unstable();
        Self { bag, features }
    }

    /// The features under each node, by rising node.
    fn groups(&self) -> impl Iterator<Item = (NodeId, Vec<usize>)> + '_ {
        let group = |group: &[(NodeId, u32)]| (group[0].0, group.iter().map(|(_, i)| *i as usize).collect());
        self.features.chunk_by(|a, b| a.0 == b.0).map(group)
    }
}

/// A frame with its bag of words.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameBow<'a> {
    pub frame: &'a Frame,
    pub bow: &'a Bow,
}

impl FrameBow<'_> {
    /// Mutually nearest features under the same node of the vocabulary; by rising feature of `self`.
    pub fn matches(&self, other: Self, thresholds: MatchThresholds) -> Vec<Match> {
        let mut found = Vec::new();
        let mut theirs = other.bow.groups().peekable();
        for (node, own) in self.bow.groups() {
            while theirs.next_if(|(n, _)| *n < node).is_some() {}
            let Some((_, group)) = theirs.next_if(|(n, _)| *n == node) else { continue };
            let descriptors = |frame: &Frame, group: &[usize]| {
                group.iter().map(|i| *frame.descriptor(*i)).collect::<Vec<_>>()
            };
            let (a, b) = (descriptors(self.frame, &own), descriptors(other.frame, &group));
            let pairs = match_mutual(&a, &b, thresholds.max_distance, thresholds.ratio);
            found.extend(pairs.into_iter().map(|m| Match { a: own[m.a], b: group[m.b], ..m }));
        }
        found.sort_unstable_by_key(|m| m.a);
        found
    }
}
