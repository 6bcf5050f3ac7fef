//! Old keyframes that may close a loop with a new one.

use crate::ids::KeyframeId;
use crate::loop_closing::config::LoopConfig;
use crate::loop_closing::uncertainty_paths::UncertaintyPaths;
use crate::map::covisibility::MIN_SHARED_LANDMARKS;
use crate::map::landmark_map::LandmarkMap;
use crate::place_recognition::bow::FrameBow;
use crate::place_recognition::keyframe_index::KeyframeIndex;
use nalgebra::{Matrix6, Vector6};
use std::collections::BTreeSet;
use trundle_core::Pose3;

/// The old keyframes that are similar to `keyframe`, the most similar first. They share no landmark with it, and are within the drift or
/// the largest unexpected correction.
pub(crate) fn loop_candidates(
    map: &LandmarkMap,
    place_index: &KeyframeIndex,
    (keyframe, own): (KeyframeId, FrameBow),
    config: &LoopConfig,
) -> Vec<KeyframeId> {
    let connected = connected(map, keyframe);
    let oldest_kept_out = map.keyframe_ids().rev().nth(config.min_age).or(map.first_keyframe());
    let here = map.keyframe(keyframe).visual_from_camera.inverse();
    let paths = UncertaintyPaths::from(map, keyframe, config);
    let is_near = |id: KeyframeId| {
        let offset = here * map.keyframe(id).visual_from_camera;
        DriftBound::along(&paths, map, (id, keyframe), config).reaches(offset)
    };
    let is_asked_for = |id: KeyframeId| Some(id) < oldest_kept_out && !connected.contains(&id) && is_near(id);
    place_index.similar_keyframes(map, own.bow, is_asked_for, config.candidates)
}

/// The keyframe, those that share landmarks with it, and those that share landmarks with these.
fn connected(map: &LandmarkMap, keyframe: KeyframeId) -> BTreeSet<KeyframeId> {
    let around = |id: KeyframeId| map.covisible(id, MIN_SHARED_LANDMARKS).into_iter().map(|(id, _)| id);
    let near: Vec<KeyframeId> = around(keyframe).collect();
    near.iter().copied().flat_map(around).chain(near.iter().copied()).chain([keyframe]).collect()
}

/// Bound of the drift between two keyframes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriftBound<'a> {
    covariance: Matrix6<f64>,
    config: &'a LoopConfig,
}

impl<'a> DriftBound<'a> {
    /// The drift between an old keyframe and a new one: the covariance that grew in between, and the drift along the least uncertain path,
    /// if one exists.
    pub fn along(
        paths: &UncertaintyPaths,
        map: &LandmarkMap,
        (old, new): (KeyframeId, KeyframeId),
        config: &'a LoopConfig,
    ) -> Self {
        let path = paths.to(old).unwrap_or_default();
        let (off, turned) = (path.translation_sigma.powi(2), path.rotation_sigma.powi(2));
        let min = Vector6::new(off, off, off, turned, turned, turned);
        let grown = map.keyframe(new).covariance + map.keyframe(old).covariance;
        Self { covariance: grown + Matrix6::from_diagonal(&min), config }
    }

    /// Whether keyframes at this offset may see the same place.
    fn reaches(&self, offset: Pose3) -> bool {
        let Self { covariance, config } = self;
        let off = |from: usize| config.max_sigmas * covariance.fixed_view::<3, 3>(from, from).trace().sqrt();
        offset.translation.norm() <= config.reach + off(0).max(config.max_correction)
            && offset.angle() <= config.turn + off(3).max(config.max_correction_turn)
    }

    /// Whether the drift explains this correction (a right perturbation) with covariance `seen`, by the chi-square of six degrees of
    /// freedom.
    pub fn allows(&self, correction: Pose3, seen: &Matrix6<f64>) -> bool {
        let tangent = correction.log();
        let Some(information) = (self.covariance + seen).try_inverse() else { return false };
        tangent.dot(&(information * tangent)) <= self.config.max_sigmas.powi(2) + CHI2_MARGIN
    }

    /// Whether a correction that the drift does not explain is too small for a look-alike place.
    pub fn allows_unexpected(&self, correction: Pose3) -> bool {
        correction.translation.norm() <= self.config.max_correction
            && correction.angle() <= self.config.max_correction_turn
    }
}

/// Difference between the chi-square quantiles of six and of one degree of freedom, at the probability of five standard deviations: 12.
/// Source: the chi-square distribution.
const CHI2_MARGIN: f64 = 12.0;
