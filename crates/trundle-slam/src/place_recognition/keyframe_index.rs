//! Keyframes similar to an image, by bags of words \[GalvezLopez12\].

use crate::ids::KeyframeId;
use crate::map::covisibility::MIN_SHARED_LANDMARKS;
use crate::map::landmark_map::LandmarkMap;
use crate::place_recognition::bow::{Bow, FrameBow};
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_vision::{PlaceIndex, Vocabulary};

/// Number of index results per requested group: 4. Further results are less similar than the groups found. Source: ours.
const RESULTS_PER_GROUP: usize = 4;

/// The bags of words of all keyframes of a map, and an index over them.
#[derive(Debug, Clone)]
pub(crate) struct KeyframeIndex {
    vocabulary: Arc<Vocabulary>,
    index: PlaceIndex,
    bows: BTreeMap<KeyframeId, Bow>,
}

impl KeyframeIndex {
    pub fn new(vocabulary: Arc<Vocabulary>) -> Self {
        Self { vocabulary, index: PlaceIndex::default(), bows: BTreeMap::new() }
    }

    pub fn vocabulary(&self) -> &Arc<Vocabulary> {
        &self.vocabulary
    }

    /// Adds the new keyframes of `map`, and drops those that were removed from it.
    pub fn update(&mut self, map: &LandmarkMap) {
        let number = |id: KeyframeId| id.index() as u32;
        let index = &mut self.index;
        self.bows.retain(|id, bow| {
            let is_alive = map.live_keyframe(*id).is_some();
            if !is_alive {
                index.remove(number(*id), &bow.bag);
            }
            is_alive
        });
        for (id, keyframe) in map.keyframes() {
            self.bows.entry(id).or_insert_with(|| {
                let bow = Bow::of(&keyframe.frame, &self.vocabulary);
                index.add(number(id), &bow.bag);
                bow
            });
        }
    }

    /// A keyframe with its bag of words; `None` for a keyframe added after the last update.
    pub fn frame_bow<'a>(&'a self, map: &'a LandmarkMap, id: KeyframeId) -> Option<FrameBow<'a>> {
        Some(FrameBow { frame: &map.live_keyframe(id)?.frame, bow: self.bows.get(&id)? })
    }

    /// The `wanted` keyframes that are most similar to `bow`, at most `max_count`: the best of each group before the second best of any
    /// group. Groups are sorted by the sum of their keyframes' similarities \[GalvezLopez12, sec. V-C\].
    pub fn similar_keyframes(
        &self,
        map: &LandmarkMap,
        bow: &Bow,
        wanted: impl Fn(KeyframeId) -> bool,
        max_count: usize,
    ) -> Vec<KeyframeId> {
        let groups = self.similar_groups(map, bow, wanted, max_count);
        let rank = |rank: usize| groups.iter().filter_map(move |group| group.members.get(rank).copied());
        (0..RESULTS_PER_GROUP * max_count).flat_map(rank).take(max_count).collect()
    }

    /// The groups of `wanted` keyframes that are most similar to `bow`, at most `max_count`, the most similar first.
    pub fn similar_groups(
        &self,
        map: &LandmarkMap,
        bow: &Bow,
        wanted: impl Fn(KeyframeId) -> bool,
        max_count: usize,
    ) -> Vec<KeyframeGroup> {
        let id = |number: u32| KeyframeId::from_index(number as usize);
        let results = self.index.query(&bow.bag, |number| wanted(id(number))).into_iter();
        let mut groups: Vec<KeyframeGroup> = Vec::new();
        for (number, similarity) in results.take(RESULTS_PER_GROUP * max_count) {
            let id = id(number);
            match groups.iter().position(|group| group.covisible.contains(&id)) {
                Some(known) => groups[known].add(id, similarity),
                None if groups.len() < max_count => groups.push(KeyframeGroup::around(map, id, similarity)),
                None => {}
            }
        }
        groups.sort_by(|a, b| b.similarity.total_cmp(&a.similarity).then(a.members.cmp(&b.members)));
        groups
    }
}

/// Similar keyframes of one place.
#[derive(Debug, Clone)]
pub(crate) struct KeyframeGroup {
    /// Keyframes that share landmarks with the first member.
    pub covisible: Vec<KeyframeId>,
    /// Sum over all members.
    pub similarity: f32,
    /// The most similar first.
    pub members: Vec<KeyframeId>,
}

impl KeyframeGroup {
    fn around(map: &LandmarkMap, id: KeyframeId, similarity: f32) -> Self {
        let covisible = map.covisible(id, MIN_SHARED_LANDMARKS).into_iter().map(|(id, _)| id).collect();
        Self { covisible, similarity, members: vec![id] }
    }

    fn add(&mut self, id: KeyframeId, similarity: f32) {
        self.similarity += similarity;
        self.members.push(id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::rgbd_frame::Frame;
    use crate::matching::projection_search::MatchThresholds;
    use crate::testing::model;
    use trundle_core::{Pose3, Stamp};
    use trundle_vision::{Descriptor, Features, Keypoint};

    /// A frame of a place: the place's features, each with up to `noise` bits flipped.
    fn seen(place: u64, noise: u64, view: u64) -> Frame {
        let mut state = place.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        let mut flips = view.wrapping_mul(0xBF58_476D_1CE4_E5B9) | 1;
        let next = |state: &mut u64| {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            *state >> 32
        };
        let mut features = Features::default();
        for i in 0..200_u16 {
            let mut words = [0; 4].map(|_: u64| next(&mut state) << 32 | next(&mut state));
            for _ in 0..noise {
                words[next(&mut flips) as usize % 4] ^= 1 << (next(&mut flips) % 64);
            }
            let (x, y) = (f32::from(i % 20) * 15.0, f32::from(i / 20) * 20.0);
            features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
            features.descriptors.push(Descriptor(words));
        }
        Frame::of(Stamp::default(), features, vec![None; 200], &model())
    }

    /// Four views each of six places.
    fn mapped() -> (LandmarkMap, KeyframeIndex) {
        let mut map = LandmarkMap::default();
        for view in 0..24 {
            let id = map.add_keyframe(seen(view / 4, 6, view), Pose3::identity());
            map.add_to_spanning_tree(id);
        }
        let mut index = KeyframeIndex::new(Vocabulary::builtin());
        index.update(&map);
        (map, index)
    }

    #[test]
    fn a_place_is_found_by_its_bag_of_words_and_not_after_its_keyframe_was_removed() {
        let (mut map, mut index) = mapped();
        let bow = Bow::of(&seen(3, 6, 99), index.vocabulary());
        let similar_keyframes =
            |map: &LandmarkMap, index: &KeyframeIndex| index.similar_keyframes(map, &bow, |_| true, 4);
        let mut found = similar_keyframes(&map, &index);
        found.sort_unstable();
        assert_eq!(found.iter().map(|id| id.index()).collect::<Vec<_>>(), vec![12, 13, 14, 15]);
        let old = |id: KeyframeId| id.index() < 14;
        assert_eq!(
            index.similar_keyframes(&map, &bow, old, 2).iter().filter(|id| id.index() / 4 == 3).count(),
            2
        );
        assert!(map.remove_keyframe(found[1]));
        index.update(&map);
        assert!(!similar_keyframes(&map, &index).contains(&found[1]));
    }

    #[test]
    fn similar_features_are_matched_under_common_nodes() {
        let vocabulary = Vocabulary::builtin();
        let (a, b, c) = (seen(1, 6, 1), seen(1, 6, 2), seen(2, 6, 3));
        let bows = [&a, &b, &c].map(|frame| Bow::of(frame, &vocabulary));
        let frame_bow = |frame, i: usize| FrameBow { frame, bow: &bows[i] };
        let thresholds = MatchThresholds { max_distance: 64, ratio: 0.8 };
        let pairs = frame_bow(&a, 0).matches(frame_bow(&b, 1), thresholds);
        assert!(pairs.len() > 120, "{} of 200", pairs.len());
        assert!(pairs.iter().all(|pair| pair.a == pair.b) && pairs.is_sorted_by_key(|pair| pair.a));
        assert!(frame_bow(&a, 0).matches(frame_bow(&c, 2), thresholds).len() < 5);
    }
}
