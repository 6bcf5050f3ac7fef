use super::LoopConfig;
use super::essential_graph::essential_graph;
use super::verify::Recognised;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::mapping::MappingConfig;
use crate::motion::carried;
use crate::search::Likeness;
use crate::sensor::Sensor;
use trundle_core::Pose3;

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
        let graph = essential_graph(map, self.sensor, (keyframe, &self.found), self.config.tied_by);
        let after = graph.solve(&self.config.graph).poses;
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

/// Moves each landmark with the keyframe that saw it first; `after` is where the keyframes `ids` go.
fn carry_landmarks(map: &mut LandmarkMap, ids: &[KeyframeId], after: &[Pose3]) {
    let correction =
        |(id, after): (&KeyframeId, &Pose3)| *after * map.keyframe(*id).visual_from_camera.inverse();
    let corrections: Vec<Pose3> = ids.iter().zip(after).map(correction).collect();
    let moved: Vec<(_, Pose3)> = map
        .landmarks()
        .filter_map(|(id, landmark)| {
            let (first, _) = landmark.observations.iter().min()?;
            let correction = corrections[ids.binary_search(first).ok()?];
            Some((id, correction))
        })
        .collect();
    map.carry(moved);
}
