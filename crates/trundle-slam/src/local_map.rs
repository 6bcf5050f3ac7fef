use crate::depth::DepthConfig;
use crate::ids::LandmarkId;
use crate::landmark::Landmark;
use crate::map::LandmarkMap;
use crate::search::Projection;
use crate::sensor::Sensor;
use trundle_core::{DepthImage, Pose3, Vector2};

/// The cosine of the steepest angle between the directions from which a landmark was seen and is looked for: 60 deg
/// \[MurArtal17\].
const MIN_DIRECTION_COSINE: f64 = 0.5;
/// A landmark farther behind the measured surface than this (m, and part of the depth) is hidden by it.
const HIDDEN: (f64, f64) = (0.1, 0.1);

/// Decides which landmarks a camera should see.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View<'a> {
    pub sensor: &'a Sensor,
    /// What the depth camera sees, to know what is hidden.
    pub depth: (&'a DepthImage, &'a DepthConfig),
    /// Half size of the search window at octave 0, px.
    pub window: f64,
    /// How many landmarks at most.
    pub most: usize,
}

impl View<'_> {
    /// The landmarks of the keyframes around that a camera at `visual_from_camera` should see, by rising id. When there are
    /// more than `most`, those with the most observations.
    pub fn landmarks(&self, map: &LandmarkMap, visual_from_camera: Pose3) -> Vec<(LandmarkId, Projection)> {
        let camera_from_visual = visual_from_camera.inverse();
        let project = |id: LandmarkId| {
            Some((id, self.project(map.landmark(id)?, camera_from_visual, visual_from_camera)?))
        };
        let mut seen: Vec<(LandmarkId, Projection)> =
            landmarks_around(map, visual_from_camera).into_iter().filter_map(project).collect();
        if seen.len() > self.most {
            let support = |id: LandmarkId| map.landmark(id).map_or(0, |l| l.observations.len());
            seen.sort_by_key(|(id, _)| (std::cmp::Reverse(support(*id)), *id));
            seen.truncate(self.most);
            seen.sort_by_key(|(id, _)| *id);
        }
        seen
    }

    fn project(&self, landmark: &Landmark, inverse: Pose3, pose: Pose3) -> Option<Projection> {
        let p_camera = inverse.transform(landmark.position);
        let (pixel, raw) = self.sensor.project(p_camera)?;
        let ray = pose.translation - landmark.position;
        let distance = ray.norm();
        if landmark.toward_camera.dot(&ray) < MIN_DIRECTION_COSINE * distance || self.hides(raw, p_camera.z) {
            return None;
        }
        // A landmark seen at octave 0 from d is seen at the octave of scale s from d / s. \[MurArtal17\]
        let scale = landmark.distance_at_octave_0 / distance;
        let finest = self.sensor.scale(0) / 1.5;
        let coarsest = self.sensor.scale(u8::MAX) * 1.5;
        if !(finest..=coarsest).contains(&scale) {
            return None;
        }
        let octave = self.sensor.octave_of(scale);
        let radius = self.window * self.sensor.scale(octave);
        let octaves = (octave.saturating_sub(1), octave + 1);
        let is_findable = self.sensor.can_find_at(raw, octave);
        let descriptor = landmark.descriptor;
        Some(Projection { pixel, depth: p_camera.z, radius, octaves, descriptor, is_findable })
    }

    /// Whether a surface stands before a point at `depth` m behind the raw pixel.
    fn hides(&self, raw: Vector2, depth: f64) -> bool {
        let (image, config) = self.depth;
        config.at(image, raw).is_some_and(|surface| depth > surface * (1.0 + HIDDEN.1) + HIDDEN.0)
    }
}

/// What the keyframes around a pose see, by rising id.
fn landmarks_around(map: &LandmarkMap, visual_from_camera: Pose3) -> Vec<LandmarkId> {
    let mut is_seen = vec![0_u64; map.landmark_bound() / 64 + 1];
    for keyframe in map.around(visual_from_camera) {
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
    use crate::testing::{map_of_one_view, sensor};
    use nalgebra::Vector6;

    #[test]
    fn what_is_hidden_turned_away_or_out_of_sight_is_not_expected() {
        let (mut map, _) = map_of_one_view(60);
        let sensor = sensor();
        let ids: Vec<_> = map.landmarks().map(|(id, _)| id).collect();
        ids.iter().for_each(|id| map.refresh(*id, &sensor));
        let config = DepthConfig::default();
        let expected = |pose: Vector6<f64>, surface: f32, most: usize| {
            let image = DepthImage::filled(320, 240, surface);
            let view = View { sensor: &sensor, depth: (&image, &config), window: 5.0, most };
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
