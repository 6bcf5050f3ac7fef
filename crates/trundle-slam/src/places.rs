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
        let id = |place: u32| KeyframeId::from_index(place as usize);
        let found = self.index.query(&words.bag, |_| true);
        let asked = found.into_iter().filter(|(place, _)| is_asked_for(id(*place)));
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
        let rank = |rank: usize| places.iter().filter_map(move |place| place.members.get(rank).copied());
        (0..4 * most).flat_map(rank).take(most).collect()
    }
}

/// Keyframes that see the same.
struct Place {
    around: Vec<KeyframeId>,
    similarity: f32,
    members: Vec<KeyframeId>,
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
