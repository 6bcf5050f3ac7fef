//! Which keyframes look like an image: bags of words over the keyframes of a map \[GalvezLopez12\].

use crate::frame::Frame;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::search::Likeness;
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_vision::{BagOfWords, Match, NodeId, PlaceIndex, Vocabulary, match_mutual};

/// The level of the vocabulary at which features of two images are worth comparing: with ten children a node, a tenth of
/// all pairs is looked at, and few right ones are missed. (\[MurArtal17\] compares a hundredth.)
const COMPARED_LEVEL: usize = 1;

/// Landmarks that tie two keyframes to one place \[MurArtal17\].
pub(crate) const SHARED: usize = 15;

/// The words of a frame.
#[derive(Debug, Clone)]
pub(crate) struct Words {
    pub bag: BagOfWords,
    /// Node at the compared level and feature, rising: the direct index.
    features: Vec<(NodeId, u32)>,
}

impl Words {
    pub fn of(frame: &Frame, vocabulary: &Vocabulary) -> Self {
        let (bag, words) = vocabulary.describe(&frame.features.descriptors);
        let node = |word: NodeId| vocabulary.node_of(word, COMPARED_LEVEL);
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

/// A frame with its words.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worded<'a> {
    pub frame: &'a Frame,
    pub words: &'a Words,
}

impl Worded<'_> {
    /// Features that look alike, each the other's best under their node of the vocabulary; by rising feature of `self`.
    pub fn matches(&self, other: Self, likeness: Likeness) -> Vec<Match> {
        let mut found = Vec::new();
        let mut theirs = other.words.groups().peekable();
        for (node, own) in self.words.groups() {
            while theirs.next_if(|(n, _)| *n < node).is_some() {}
            let Some((_, group)) = theirs.next_if(|(n, _)| *n == node) else { continue };
            let descriptors = |frame: &Frame, group: &[usize]| {
                group.iter().map(|i| *frame.descriptor(*i)).collect::<Vec<_>>()
            };
            let (a, b) = (descriptors(self.frame, &own), descriptors(other.frame, &group));
            let pairs = match_mutual(&a, &b, likeness.max_distance, likeness.ratio);
            found.extend(pairs.into_iter().map(|m| Match { a: own[m.a], b: group[m.b], ..m }));
        }
        found.sort_unstable_by_key(|m| m.a);
        found
    }
}

/// The words of all keyframes of a map, and an index over them.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    vocabulary: Arc<Vocabulary>,
    index: PlaceIndex,
    words: BTreeMap<KeyframeId, Words>,
}

impl Places {
    pub fn new(vocabulary: Arc<Vocabulary>) -> Self {
        Self { vocabulary, index: PlaceIndex::default(), words: BTreeMap::new() }
    }

    pub fn vocabulary(&self) -> &Arc<Vocabulary> {
        &self.vocabulary
    }

    /// Takes in the keyframes that are new in `map`, and forgets those that it has no more.
    pub fn follow(&mut self, map: &LandmarkMap) {
        let place = |id: KeyframeId| id.index() as u32;
        let index = &mut self.index;
        self.words.retain(|id, words| {
            let is_there = map.live_keyframe(*id).is_some();
            if !is_there {
                index.remove(place(*id), &words.bag);
            }
            is_there
        });
        for (id, keyframe) in map.keyframes() {
            self.words.entry(id).or_insert_with(|| {
                let words = Words::of(&keyframe.frame, &self.vocabulary);
                index.add(place(id), &words.bag);
                words
            });
        }
    }

    /// A keyframe with its words; `None` of one that the map had not when it was last followed.
    pub fn worded<'a>(&'a self, map: &'a LandmarkMap, id: KeyframeId) -> Option<Worded<'a>> {
        Some(Worded { frame: &map.live_keyframe(id)?.frame, words: self.words.get(&id)? })
    }

    /// The keyframes asked for that look most like `words`, at most `most`: the best of each place before the second best
    /// of any, and places by the similarity of all their keyframes together \[GalvezLopez12, sec. V-C\].
    pub fn alike(
        &self,
        map: &LandmarkMap,
        words: &Words,
        is_asked_for: impl Fn(KeyframeId) -> bool,
        most: usize,
    ) -> Vec<KeyframeId> {
        let places = self.places_alike(map, words, is_asked_for, most);
        let rank = |rank: usize| places.iter().filter_map(move |place| place.members.get(rank).copied());
        (0..4 * most).flat_map(rank).take(most).collect()
    }

    /// The places that look most like `words`, at most `most`, the likeliest first.
    pub fn places_alike(
        &self,
        map: &LandmarkMap,
        words: &Words,
        is_asked_for: impl Fn(KeyframeId) -> bool,
        most: usize,
    ) -> Vec<Place> {
        let id = |place: u32| KeyframeId::from_index(place as usize);
        let asked = self.index.query(&words.bag, |place| is_asked_for(id(place))).into_iter();
        let mut places: Vec<Place> = Vec::new();
        for (place, similarity) in asked.take(4 * most) {
            let id = id(place);
            match places.iter().position(|p| p.around.contains(&id)) {
                Some(known) => places[known].join(id, similarity),
                None if places.len() < most => places.push(Place::at(map, id, similarity)),
                None => {}
            }
        }
        places.sort_by(|a, b| b.similarity.total_cmp(&a.similarity).then(a.members.cmp(&b.members)));
        places
    }
}

/// Keyframes that see the same.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    pub around: Vec<KeyframeId>,
    /// Of all its members together.
    pub similarity: f32,
    /// Those that look alike, the likeliest first.
    pub members: Vec<KeyframeId>,
}

impl Place {
    fn at(map: &LandmarkMap, id: KeyframeId, similarity: f32) -> Self {
        let around = map.covisible(id, SHARED).into_iter().map(|(id, _)| id).collect();
        Self { around, similarity, members: vec![id] }
    }

    fn join(&mut self, id: KeyframeId, similarity: f32) {
        self.similarity += similarity;
        self.members.push(id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::sensor;
    use trundle_core::{Pose3, Stamp};
    use trundle_vision::{Descriptor, Features, Keypoint};

    /// What is seen at a place: features of its own, each with up to `noise` bits turned.
    fn seen(place: u64, noise: u64, view: u64) -> Frame {
        let mut state = place.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        let mut turns = view.wrapping_mul(0xBF58_476D_1CE4_E5B9) | 1;
        let next = |state: &mut u64| {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            *state >> 32
        };
        let mut features = Features::default();
        for i in 0..200_u16 {
            let mut words = [0; 4].map(|_: u64| next(&mut state) << 32 | next(&mut state));
            for _ in 0..noise {
                words[next(&mut turns) as usize % 4] ^= 1 << (next(&mut turns) % 64);
            }
            let (x, y) = (f32::from(i % 20) * 15.0, f32::from(i / 20) * 20.0);
            features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
            features.descriptors.push(Descriptor(words));
        }
        Frame::of(Stamp::default(), features, vec![None; 200], &sensor())
    }

    /// Four views each of six places.
    fn mapped() -> (LandmarkMap, Places) {
        let mut map = LandmarkMap::default();
        for view in 0..24 {
            let id = map.add_keyframe(seen(view / 4, 6, view), Pose3::identity());
            map.enter_tree(id);
        }
        let mut places = Places::new(Vocabulary::builtin());
        places.follow(&map);
        (map, places)
    }

    #[test]
    fn a_place_is_found_by_its_words_and_not_when_it_is_forgotten() {
        let (mut map, mut places) = mapped();
        let words = Words::of(&seen(3, 6, 99), places.vocabulary());
        let alike = |map: &LandmarkMap, places: &Places| places.alike(map, &words, |_| true, 4);
        let mut found = alike(&map, &places);
        found.sort_unstable();
        assert_eq!(found.iter().map(|id| id.index()).collect::<Vec<_>>(), vec![12, 13, 14, 15]);
        let old = |id: KeyframeId| id.index() < 14;
        assert_eq!(places.alike(&map, &words, old, 2).iter().filter(|id| id.index() / 4 == 3).count(), 2);
        assert!(map.forget_keyframe(found[1]));
        places.follow(&map);
        assert!(!alike(&map, &places).contains(&found[1]));
    }

    #[test]
    fn what_looks_alike_is_paired_under_the_nodes_it_shares() {
        let vocabulary = Vocabulary::builtin();
        let (a, b, c) = (seen(1, 6, 1), seen(1, 6, 2), seen(2, 6, 3));
        let words = [&a, &b, &c].map(|frame| Words::of(frame, &vocabulary));
        let worded = |frame, i: usize| Worded { frame, words: &words[i] };
        let likeness = Likeness { max_distance: 64, ratio: 0.8 };
        let pairs = worded(&a, 0).matches(worded(&b, 1), likeness);
        assert!(pairs.len() > 120, "{} of 200", pairs.len());
        assert!(pairs.iter().all(|pair| pair.a == pair.b) && pairs.is_sorted_by_key(|pair| pair.a));
        assert!(worded(&a, 0).matches(worded(&c, 2), likeness).len() < 5);
    }
}
