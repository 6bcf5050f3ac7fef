use super::LoopConfig;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use nalgebra::Matrix6;
use std::collections::BTreeSet;
use trundle_core::Pose3;

/// Landmarks that tie two keyframes \[MurArtal17\].
const SHARED: usize = 15;

/// The old keyframes that `keyframe` may see the place of, nearest first: not tied to it, and near by when the drift is
/// allowed for.
pub(super) fn candidates(map: &LandmarkMap, keyframe: KeyframeId, config: &LoopConfig) -> Vec<KeyframeId> {
    let tied = tied(map, keyframe);
    let oldest_kept_out = map.keyframe_ids().rev().nth(config.least_age).or(map.first_keyframe());
    let here = map.keyframe(keyframe);
    let mut near: Vec<(f64, KeyframeId)> = Vec::new();
    let mut way = Way::default();
    let ids: Vec<KeyframeId> = map.keyframe_ids().take_while(|id| *id <= keyframe).collect();
    for (id, next) in ids.iter().copied().zip(ids.iter().copied().skip(1)).rev() {
        way.add(map, id, next);
        if Some(id) < oldest_kept_out && !tied.contains(&id) {
            let offset = here.visual_from_camera.inverse() * map.keyframe(id).visual_from_camera;
            let drift = Drift::along(map, way, id, keyframe, config);
            near.extend(drift.nearness(offset, config).map(|nearness| (nearness, id)));
        }
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.into_iter().take(config.candidates).map(|(_, id)| id).collect()
}

/// The keyframe, those that share landmarks with it, and those that share landmarks with these.
fn tied(map: &LandmarkMap, keyframe: KeyframeId) -> BTreeSet<KeyframeId> {
    let around = |id: KeyframeId| map.covisible(id, SHARED).into_iter().map(|(id, _)| id);
    let near: Vec<KeyframeId> = around(keyframe).collect();
    near.iter().copied().flat_map(around).chain(near.iter().copied()).chain([keyframe]).collect()
}

/// How far the camera went and turned between two keyframes, keyframe by keyframe: m and rad.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    length: f64,
    turn: f64,
}

impl Way {
    /// From one keyframe to the next one, added.
    fn add(&mut self, map: &LandmarkMap, from: KeyframeId, to: KeyframeId) {
        let step = map.keyframe(from).visual_from_camera.inverse() * map.keyframe(to).visual_from_camera;
        self.length += step.translation.norm();
        self.turn += step.angle();
    }
}

/// How far two keyframes may be off against each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drift {
    covariance: Matrix6<f64>,
    most_sigmas: f64,
}

impl Drift {
    /// Of `new` against `old`: the covariance that grew between, and a part of the way.
    pub(super) fn between(map: &LandmarkMap, old: KeyframeId, new: KeyframeId, config: &LoopConfig) -> Self {
        let mut way = Way::default();
        let between: Vec<KeyframeId> = map.keyframe_ids().filter(|id| (old..=new).contains(id)).collect();
        between.windows(2).for_each(|pair| way.add(map, pair[0], pair[1]));
        Self::along(map, way, old, new, config)
    }

    /// The same where the way between is known.
    fn along(map: &LandmarkMap, way: Way, old: KeyframeId, new: KeyframeId, config: &LoopConfig) -> Self {
        let off = (config.drift_part * way.length).hypot(config.tie_sigma).powi(2);
        let turned = (config.drift_part * way.turn).hypot(config.tie_sigma_turn).powi(2);
        let least = nalgebra::Vector6::new(off, off, off, turned, turned, turned);
        let grown = map.keyframe(new).covariance + map.keyframe(old).covariance;
        Self { covariance: grown + Matrix6::from_diagonal(&least), most_sigmas: config.most_sigmas }
    }

    /// How near an offset is, in reaches and turns; `None` when too far even for this drift.
    fn nearness(&self, offset: Pose3, config: &LoopConfig) -> Option<f64> {
        let sigma = |from: usize| self.covariance.fixed_view::<3, 3>(from, from).trace().sqrt();
        let off = offset.translation.norm() / (config.reach + self.most_sigmas * sigma(0));
        let turned = offset.angle() / (config.turn + self.most_sigmas * sigma(3));
        (off <= 1.0 && turned <= 1.0).then_some(off + turned)
    }

    /// Whether the drift may have been this correction (a right perturbation): its Mahalanobis distance, in standard
    /// deviations of each of its six parts.
    pub(super) fn allows(&self, correction: Pose3) -> bool {
        let tangent = correction.log();
        let Some(information) = self.covariance.try_inverse() else { return false };
        let squared = tangent.dot(&(information * tangent));
        squared <= 6.0 * self.most_sigmas * self.most_sigmas
    }
}
