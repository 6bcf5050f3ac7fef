use super::LoopConfig;
use super::common_sight::common_sight;
use super::verify::Recognised;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::mapping::MappingConfig;
use crate::motion::carried;
use crate::search::Likeness;
use crate::sensor::Sensor;
use crate::ties::known_ties;
use nalgebra::Matrix6;
use std::collections::BTreeSet;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{CHI2_95_6, Huber, PoseConstraint, PoseGraph};

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

    /// Every keyframe tied to the others by what they both see, by the wheels and to the floor, as they stand to each other
    /// now, each tie as certain as that is; and the newest to the place it recognised.
    fn graph(&self, map: &LandmarkMap, keyframe: KeyframeId, ids: &[KeyframeId]) -> PoseGraph {
        let node = |id: KeyframeId| ids.binary_search(&id).expect("invariant: the keyframe is alive");
        let poses = ids.iter().map(|id| map.keyframe(*id).visual_from_camera);
        let poses: Vec<Pose3> = poses.chain([Pose3::identity()]).collect();
        let as_now = |(from, to): (usize, usize), information: Matrix6<f64>| PoseConstraint {
            from,
            to,
            from_to: poses[from].inverse() * poses[to],
            information,
        };
        let seen = common_sight(map, self.sensor, ids, self.pairs(map, ids).into_iter());
        let mut ties: Vec<PoseConstraint> =
            seen.into_iter().map(|(pair, by)| as_now(pair, by + Matrix6::identity())).collect();
        for tie in known_ties(map, ids, |i| i == 0) {
            let is_floor = tie.from == ids.len();
            ties.push(if is_floor { tie } else { as_now((tie.from, tie.to), believed(&tie, &poses)) });
        }
        let candidate = node(self.found.candidate);
        let from_to = poses[candidate].inverse() * self.found.visual_from_camera;
        let information = self.found.covariance.try_inverse().unwrap_or_default();
        ties.push(PoseConstraint { from: candidate, to: node(keyframe), from_to, information });
        let fixed: Vec<bool> = (0..poses.len()).map(|i| i == 0 || i == ids.len()).collect();
        PoseGraph::new(poses, &fixed, ties).expect("invariant: every index was counted here")
    }

    /// The pairs of keyframes that the graph ties, by their places: the essential graph \[MurArtal17\] of the spanning tree,
    /// strong covisibility and earlier loops, and neighbours in time.
    fn pairs(&self, map: &LandmarkMap, ids: &[KeyframeId]) -> BTreeSet<(usize, usize)> {
        let place = |id: &KeyframeId| ids.binary_search(id).ok();
        let mut pairs: BTreeSet<(usize, usize)> = (1..ids.len()).map(|i| (i - 1, i)).collect();
        for (i, id) in ids.iter().enumerate() {
            let tree = &map.keyframe(*id).tree;
            let shared = map.covisible(*id, self.config.tied_by).into_iter().map(|(other, _)| other);
            let tied = shared.chain(tree.parent).chain(tree.loops.iter().copied());
            let others: Vec<usize> =
                tied.filter_map(|other| place(&other)).filter(|other| *other != i).collect();
            pairs.extend(others.into_iter().map(|other| (other.min(i), other.max(i))));
        }
        pairs
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

/// What a tie by the wheels says where the poses are these: where they slipped, no more than under the Huber loss.
fn believed(tie: &PoseConstraint, poses: &[Pose3]) -> Matrix6<f64> {
    let off = (tie.from_to.inverse() * poses[tie.from].inverse() * poses[tie.to]).log();
    tie.information * Huber::beyond(CHI2_95_6).weight(off.dot(&(tie.information * off)))
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
