//! Corrects the map after a place was recognized.

use crate::ids::{KeyframeId, LandmarkId};
use crate::local_mapping::local_mapper::LocalMapper;
use crate::loop_closing::config::LoopConfig;
use crate::loop_closing::essential_graph::essential_graph;
use crate::loop_closing::place_verification::RecognizedPlace;
use crate::map::landmark_map::LandmarkMap;
use crate::motion::uncertain_pose::propagated;
use crate::optimisation::map_optimisation::MapOptimisation;
use trundle_core::Pose3;

/// A recognized place, and the inputs of the map's correction.
#[derive(Debug, Clone)]
pub(crate) struct LoopCorrection<'a> {
    pub mapper: LocalMapper<'a>,
    pub config: &'a LoopConfig,
    pub place: RecognizedPlace,
}

impl LoopCorrection<'_> {
    /// Distributes the drift over the keyframes by a pose graph, moves each landmark with the keyframe that saw it first, fuses duplicate
    /// landmarks, and begins the bundle adjustment of the whole map.
    pub fn apply(&self, map: &mut LandmarkMap, optimisation: &mut MapOptimisation, keyframe: KeyframeId) {
        let ids: Vec<KeyframeId> = map.keyframe_ids().collect();
        let graph = essential_graph(map, self.mapper.model, (keyframe, &self.place), self.config.tied_by);
        let after = graph.solve(&self.config.graph).poses;
        move_landmarks(map, &ids, &after);
        for (id, pose) in ids.into_iter().zip(after) {
            map.move_keyframe(id, pose);
        }
        self.mapper.fuse_around(map, keyframe, &self.place.landmarks);
        map.add_loop_edge(self.place.candidate, keyframe);
        self.set_covariance(map, keyframe);
        optimisation.begin_all(map);
    }

    /// Sets the keyframe's covariance to that of the recognized place and of the pose relative to it.
    fn set_covariance(&self, map: &mut LandmarkMap, keyframe: KeyframeId) {
        let (candidate, own) = (map.keyframe(self.place.candidate), map.keyframe(keyframe));
        let offset = candidate.visual_from_camera.inverse() * own.visual_from_camera;
        let map_covariance = propagated(&candidate.map_covariance, offset);
        map.set_covariances(keyframe, map_covariance + self.place.covariance, map_covariance);
    }
}

/// Moves each landmark with the keyframe that saw it first; `after` are the new poses of the keyframes `ids`.
fn move_landmarks(map: &mut LandmarkMap, ids: &[KeyframeId], after: &[Pose3]) {
    let correction =
        |(id, after): (&KeyframeId, &Pose3)| *after * map.keyframe(*id).visual_from_camera.inverse();
    let corrections: Vec<Pose3> = ids.iter().zip(after).map(correction).collect();
    let moves: Vec<(LandmarkId, Pose3)> = map
        .landmarks()
        .filter_map(|(id, landmark)| {
            let (first, _) = landmark.observations.iter().min()?;
            let correction = corrections[ids.binary_search(first).ok()?];
            Some((id, correction))
        })
        .collect();
    map.transform_landmarks(moves);
}
