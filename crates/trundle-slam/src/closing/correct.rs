use super::LoopConfig;
use super::verify::Recognised;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::mapping::MappingConfig;
use crate::motion::carried;
use crate::places::SHARED;
use crate::search::Likeness;
use crate::sensor::Sensor;
use nalgebra::Matrix6;
use std::collections::BTreeSet;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{PoseConstraint, PoseGraph};

/// Mends the map once a place is recognised.
#[derive(Debug, Clone)]
pub(super) struct Correction<'a> {
    pub sensor: &'a Sensor,
    pub config: &'a LoopConfig,
    pub mapping: &'a MappingConfig,
    pub likeness: Likeness,
    pub window: f64,
    pub found: Recognised,
}

impl Correction<'_> {
    /// Spreads the drift over the keyframes, lets each landmark go with the keyframe that saw it first, makes one of
    /// those that are there twice, and begins to refine the whole map.
    pub fn apply(&self, map: &mut LandmarkMap, keyframe: KeyframeId) {
        let ids: Vec<KeyframeId> = map.keyframe_ids().collect();
        let after = self.graph(map, keyframe, &ids).solve(&self.config.graph).poses;
        carry_landmarks(map, &ids, &after);
        for (id, pose) in ids.into_iter().zip(after) {
            map.move_keyframe(id, pose);
        }
        self.fuse(map, keyframe);
        map.tie(self.found.candidate, keyframe);
        self.trust(map, keyframe);
        map.begin_refining_all();
    }

    /// The keyframe is known as well as the place that it recognised, and as it was found there.
    fn trust(&self, map: &mut LandmarkMap, keyframe: KeyframeId) {
        let (place, own) = (map.keyframe(self.found.candidate), map.keyframe(keyframe));
        let offset = place.visual_from_camera.inverse() * own.visual_from_camera;
        let ground = carried(&place.ground, offset);
        map.set_covariances(keyframe, ground + self.found.covariance, ground);
    }

    /// Every keyframe tied to the one before it and to those it shares many landmarks with, as they stand to each other
    /// now, and the newest to the place it recognised.
    fn graph(&self, map: &LandmarkMap, keyframe: KeyframeId, ids: &[KeyframeId]) -> PoseGraph {
        let node = |id: KeyframeId| ids.binary_search(&id).expect("invariant: the keyframe is alive");
        let poses: Vec<Pose3> = ids.iter().map(|id| map.keyframe(*id).visual_from_camera).collect();
        let mut pairs: BTreeSet<(usize, usize)> = (1..poses.len()).map(|i| (i - 1, i)).collect();
        for (i, id) in ids.iter().enumerate() {
            let shared = map.covisible(*id, self.config.tied_by).into_iter().map(|(other, _)| node(other));
            pairs.extend(shared.filter(|other| *other < i).map(|other| (other, i)));
        }
        let tie = |(from, to): (usize, usize)| {
            let as_now = self.tie(from, to, poses[from].inverse() * poses[to]);
            let information = loose(map, (ids[from], ids[to])).unwrap_or(as_now.information);
            PoseConstraint { information, ..as_now }
        };
        let mut ties: Vec<PoseConstraint> = pairs.into_iter().map(tie).collect();
        let candidate = node(self.found.candidate);
        let seen = poses[candidate].inverse() * self.found.visual_from_camera;
        ties.push(self.tie(candidate, node(keyframe), seen));
        let fixed: Vec<bool> = (0..poses.len()).map(|i| i == 0).collect();
        PoseGraph::new(poses, &fixed, ties).expect("invariant: every index was counted here")
    }

    fn tie(&self, from: usize, to: usize, from_to: Pose3) -> PoseConstraint {
        let (off, turned) = (self.config.tie_sigma.powi(-2), self.config.tie_sigma_turn.powi(-2));
        let information =
            Matrix6::from_diagonal(&nalgebra::Vector6::new(off, off, off, turned, turned, turned));
        PoseConstraint { from, to, from_to, information }
    }

    /// Looks for the old place's landmarks in the newest keyframe and those around it.
    fn fuse(&self, map: &mut LandmarkMap, keyframe: KeyframeId) {
        let around = map.covisible(keyframe, 15).into_iter().map(|(id, _)| id);
        let targets: Vec<KeyframeId> =
            [keyframe].into_iter().chain(around.take(self.mapping.fused_keyframes)).collect();
        let mapper = crate::mapping::Mapper {
            sensor: self.sensor,
            config: self.mapping,
            likeness: self.likeness,
            window: self.window,
        };
        for target in targets {
            mapper.fuse_into(map, target, &self.found.landmarks);
        }
    }
}

/// What is known of the way between two neighbours in time that hardly see anything in common, where only wheels tell it:
/// the drift that a loop shows was mostly made there.
fn loose(map: &LandmarkMap, (from, to): (KeyframeId, KeyframeId)) -> Option<Matrix6<f64>> {
    let rolled = map.keyframe(to).rolled.filter(|rolled| rolled.from == from)?;
    let is_seen = map.covisible(to, SHARED).into_iter().any(|(id, _)| id == from);
    rolled.information().filter(|_| !is_seen)
}

/// Moves each landmark with the keyframe that saw it first; `after` is where the keyframes `ids` go.
fn carry_landmarks(map: &mut LandmarkMap, ids: &[KeyframeId], after: &[Pose3]) {
    let correction =
        |(id, after): (&KeyframeId, &Pose3)| *after * map.keyframe(*id).visual_from_camera.inverse();
    let corrections: Vec<Pose3> = ids.iter().zip(after).map(correction).collect();
    let moved: Vec<(_, Vector3)> = map
        .landmarks()
        .filter_map(|(id, landmark)| {
            let (first, _) = landmark.observations.iter().min()?;
            let correction = corrections[ids.binary_search(first).ok()?];
            Some((id, correction.transform(landmark.position)))
        })
        .collect();
    for (id, position) in moved {
        if let Some(landmark) = map.landmark_mut(id) {
            landmark.position = position;
        }
    }
}
