//! Landmarks expected in a camera's view.

use crate::frame::depth::DepthConfig;
use crate::frame::observation_model::ObservationModel;
use crate::ids::LandmarkId;
use crate::map::covisibility::keyframes_around;
use crate::map::landmark::Landmark;
use crate::map::landmark_map::LandmarkMap;
use crate::matching::projection_search::Projection;
use crate::tracking::config::TrackingConfig;
use trundle_core::{DepthImage, Pose3, Vector2};

/// Smallest cosine of the angle between a landmark's mean viewing direction and the present one: 0.5 (60 deg). At larger angles the
/// landmark is not expected. Source: \[MurArtal17\].
const MIN_DIRECTION_COSINE: f64 = 0.5;
/// Distance behind the measured surface beyond which a landmark is hidden: 0.1 m, plus [`OCCLUSION_MARGIN_RATIO`] of the depth. Source:
/// ours.
const OCCLUSION_MARGIN_M: f64 = 0.1;
/// Share of the depth that adds to [`OCCLUSION_MARGIN_M`]. Source: ours.
const OCCLUSION_MARGIN_RATIO: f64 = 0.1;
/// Factor by which a landmark may be finer than the finest octave, or coarser than the coarsest: 1.5. Beyond it the landmark is not
/// expected. Source: \[MurArtal17\].
const OCTAVE_MARGIN: f64 = 1.5;

/// Selects the landmarks expected in a camera's view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalMapQuery<'a> {
    pub model: &'a ObservationModel,
    /// The depth image, for hidden landmarks.
    pub depth: (&'a DepthImage, &'a DepthConfig),
    /// Half size of the search window at octave 0, px.
    pub window_px: f64,
    pub max_landmarks: usize,
}

impl<'a> LocalMapQuery<'a> {
    pub fn new(
        model: &'a ObservationModel,
        depth: (&'a DepthImage, &'a DepthConfig),
        config: &TrackingConfig,
    ) -> Self {
        let TrackingConfig { map_window_px: window_px, max_landmarks, .. } = *config;
        Self { model, depth, window_px, max_landmarks }
    }

    /// The landmarks of the keyframes around that are expected in the view of a camera at `visual_from_camera`, by rising id. Of more than
    /// `max_landmarks`, those with the largest number of observations.
    pub fn landmarks(&self, map: &LandmarkMap, visual_from_camera: Pose3) -> Vec<(LandmarkId, Projection)> {
        let camera_from_visual = visual_from_camera.inverse();
        let project = |id: LandmarkId| {
            Some((id, self.project(map.landmark(id)?, camera_from_visual, visual_from_camera)?))
        };
        let mut seen: Vec<(LandmarkId, Projection)> =
            landmarks_around(map, visual_from_camera).into_iter().filter_map(project).collect();
        if seen.len() > self.max_landmarks {
            let support = |id: LandmarkId| map.landmark(id).map_or(0, |l| l.observations.len());
            seen.sort_by_key(|(id, _)| (std::cmp::Reverse(support(*id)), *id));
            seen.truncate(self.max_landmarks);
            seen.sort_by_key(|(id, _)| *id);
        }
        seen
    }

    fn project(&self, landmark: &Landmark, inverse: Pose3, pose: Pose3) -> Option<Projection> {
        let p_camera = inverse.transform(landmark.position);
        let (pixel, raw) = self.model.project(p_camera)?;
        let ray = pose.translation - landmark.position;
        let distance = ray.norm();
        if landmark.toward_camera.dot(&ray) < MIN_DIRECTION_COSINE * distance || self.hides(raw, p_camera.z) {
            return None;
        }
        // A landmark in octave 0 at distance d is in the octave of scale s at distance d / s. \[MurArtal17\]
        let scale = landmark.distance_at_octave_0 / distance;
        let finest = self.model.scale(0) / OCTAVE_MARGIN;
        let coarsest = self.model.scale(u8::MAX) * OCTAVE_MARGIN;
        if !(finest..=coarsest).contains(&scale) {
            return None;
        }
        let octave = self.model.octave_of(scale);
        let radius = self.window_px * self.model.scale(octave);
        let octaves = (octave.saturating_sub(1), octave + 1);
        let is_findable = self.model.can_find_at(raw, octave);
        let descriptor = landmark.descriptor;
        Some(Projection { pixel, depth: p_camera.z, radius, octaves, descriptor, is_findable })
    }

    /// Whether a surface hides a point at `depth` m behind the raw pixel.
    fn hides(&self, raw: Vector2, depth: f64) -> bool {
        let (image, config) = self.depth;
        config
            .at(image, raw)
            .is_some_and(|surface| depth > surface * (1.0 + OCCLUSION_MARGIN_RATIO) + OCCLUSION_MARGIN_M)
    }
}

/// Landmarks of the keyframes around a pose, by rising id.
fn landmarks_around(map: &LandmarkMap, visual_from_camera: Pose3) -> Vec<LandmarkId> {
    let mut is_seen = vec![0_u64; map.landmark_bound() / 64 + 1];
    for keyframe in keyframes_around(map, visual_from_camera) {
        for id in map.keyframe(keyframe).landmarks.iter().flatten() {
            is_seen[id.index() / 64] |= 1 << (id.index() % 64);
        }
    }
    let mut ids = Vec::new();
    for (word, mut bits) in is_seen.into_iter().enumerate() {
        while bits != 0 {
            ids.push(LandmarkId::from_index(64 * word + bits.trailing_zeros() as usize));
            bits &= bits - 1;
        }
    }
    ids
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{map_of_one_view, model};
    use nalgebra::Vector6;

    #[test]
    fn landmarks_that_are_occluded_turned_away_or_out_of_view_are_not_expected() {
        let (mut map, _) = map_of_one_view(60);
        let model = model();
        let ids: Vec<_> = map.landmarks().map(|(id, _)| id).collect();
        ids.iter().for_each(|id| map.refresh(*id, &model));
        let config = DepthConfig::default();
        let expected = |pose: Vector6<f64>, surface: f32, max_landmarks: usize| {
            let image = DepthImage::filled(320, 240, surface);
            let view =
                LocalMapQuery { model: &model, depth: (&image, &config), window_px: 5.0, max_landmarks };
            view.landmarks(&map, Pose3::exp(pose)).len()
        };
        let here = Vector6::zeros();
        assert_eq!(expected(here, 2.0, 100), 60);
        assert_eq!(expected(here, 0.0, 100), 60, "no depth hides nothing");
        assert_eq!(expected(here, 1.0, 100), 0, "a wall in front");
        assert_eq!(expected(here, 2.0, 7), 7);
        assert_eq!(expected(Vector6::new(0.0, 0.0, 0.0, 0.0, 3.1, 0.0), 2.0, 100), 0, "behind the camera");
        assert_eq!(expected(Vector6::new(0.0, 0.0, 4.0, 0.0, 3.1, 0.0), 2.0, 100), 0, "from behind");
        assert_eq!(expected(Vector6::new(0.0, 0.0, -9.0, 0.0, 0.0, 0.0), 0.0, 100), 0, "too small");
    }
}
