use super::RgbdSlam;
use crate::ids::KeyframeId;

impl RgbdSlam {
    /// The covisibility graph of the active map: pairs of keyframes that share at least `least` landmarks, the older first,
    /// and how many they share \[MurArtal17\].
    pub fn covisibility(&self, least: usize) -> Vec<(KeyframeId, KeyframeId, usize)> {
        let map = &self.active.map;
        let older = |id: KeyframeId| {
            let shared = map.covisible(id, least.max(1)).into_iter();
            shared.filter(move |(other, _)| *other < id).map(move |(other, shared)| (other, id, shared))
        };
        map.keyframes().flat_map(|(id, _)| older(id)).collect()
    }

    /// The loops closed in the active map: the keyframe that had seen the place, and the one that saw it again.
    pub fn loops(&self) -> Vec<(KeyframeId, KeyframeId)> {
        self.active.map.loops().collect()
    }
}
