//! Searches projected points among the features of a frame.

use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::map::landmark::Landmark;
use trundle_core::{Pose3, Vector2, Vector3};
use trundle_vision::Descriptor;

/// A point expected in the image, and its search window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projection {
    /// Expected position, rectified px.
    pub pixel: Vector2,
    /// Expected depth along the optical axis, m.
    pub depth: f64,
    /// Radius of the search window, px.
    pub radius: f64,
    /// Lowest and highest octave to search.
    pub octaves: (u8, u8),
    /// Descriptor of the point.
    pub descriptor: Descriptor,
    /// Whether the extractor can find a feature there.
    pub is_findable: bool,
}

impl Projection {
    /// The projection of a landmark, with a window of `window` px at octave 0, and the landmark in the camera frame; `None`
    /// outside the image.
    pub fn of(
        landmark: &Landmark,
        camera_from_visual: Pose3,
        model: &ObservationModel,
        window: f64,
    ) -> Option<(Self, Vector3)> {
        let p_camera = camera_from_visual.transform(landmark.position);
        let (pixel, raw) = model.project(p_camera)?;
        let octave = model.octave_of(landmark.distance_at_octave_0 / p_camera.norm());
        let radius = window * model.scale(octave);
        let octaves = (octave.saturating_sub(1), octave + 1);
        let is_findable = model.can_find_at(raw, octave);
        let descriptor = landmark.descriptor;
        Some((Self { pixel, depth: p_camera.z, radius, octaves, descriptor, is_findable }, p_camera))
    }
}

/// Thresholds of similarity for a match of descriptors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MatchThresholds {
    /// Highest distance, bits.
    pub max_distance: u32,
    /// Highest quotient of the best distance and the next best on the same octave.
    pub ratio: f32,
}

/// Largest relative difference of a feature's depth from its prediction, besides three standard deviations: 0.2. Beyond the sum the feature
/// is not matched. Source: ours.
const DEPTH_TOLERANCE_RATIO: f64 = 0.2;

/// Finds each projection's feature among the `free` ones of `frame`: (feature, projection), by rising feature. Each feature is matched with
/// the most similar projection, or the first of equally similar ones.
pub(crate) fn search(
    frame: &Frame,
    free: &[bool],
    projections: &[Projection],
    thresholds: MatchThresholds,
) -> Vec<(usize, usize)> {
    let mut taken: Vec<Option<(u32, usize)>> = vec![None; frame.len()];
    for (index, projection) in projections.iter().enumerate() {
        let Some((feature, distance)) = best(frame, free, projection, thresholds) else { continue };
        if taken[feature].is_none_or(|(held, _)| distance < held) {
            taken[feature] = Some((distance, index));
        }
    }
    taken.iter().enumerate().filter_map(|(feature, t)| Some((feature, (*t)?.1))).collect()
}

/// The most similar feature within the window, unless a second one is nearly as similar.
fn best(
    frame: &Frame,
    free: &[bool],
    projection: &Projection,
    thresholds: MatchThresholds,
) -> Option<(usize, u32)> {
    let mut first: Option<(usize, u32)> = None;
    let mut second = first;
    for feature in frame.near(projection.pixel, projection.radius, projection.octaves) {
        if !free[feature] || !depth_agrees(frame, feature, projection.depth) {
            continue;
        }
        let distance = projection.descriptor.distance(frame.descriptor(feature));
        if first.is_none_or(|(_, d)| distance < d) {
            (first, second) = (Some((feature, distance)), first);
        } else if second.is_none_or(|(_, d)| distance < d) {
            second = Some((feature, distance));
        }
    }
    let (feature, distance) = first.filter(|(_, d)| *d <= thresholds.max_distance)?;
    let rival = second.filter(|(other, _)| frame.octave(*other) == frame.octave(feature));
    let clear = rival.is_none_or(|(_, next)| distance as f32 <= thresholds.ratio * next as f32);
    clear.then_some((feature, distance))
}

/// Whether the feature's own depth agrees with the projection's; true without a depth.
fn depth_agrees(frame: &Frame, feature: usize, depth: f64) -> bool {
    frame.depths[feature].is_none_or(|seen| {
        (seen.value - 1.0 / depth).abs()
            <= DEPTH_TOLERANCE_RATIO * seen.value.max(1.0 / depth) + 3.0 * seen.sigma
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::frame_with_depth;

    const STRICT: MatchThresholds = MatchThresholds { max_distance: 30, ratio: 0.8 };

    fn looking_for(frame: &Frame, feature: usize, radius: f64) -> Projection {
        let (pixel, descriptor) = (frame.pixels[feature], *frame.descriptor(feature));
        Projection { pixel, depth: 2.0, radius, octaves: (0, 1), descriptor, is_findable: true }
    }

    #[test]
    fn a_projection_finds_its_feature_among_its_neighbours() {
        let frame = frame_with_depth(64);
        let free = vec![true; 64];
        let projections = [looking_for(&frame, 20, 25.0), looking_for(&frame, 3, 25.0)];
        assert_eq!(search(&frame, &free, &projections, STRICT), vec![(3, 1), (20, 0)]);
    }

    #[test]
    fn features_out_of_the_window_taken_or_at_another_depth_or_octave_are_not_found() {
        let frame = frame_with_depth(64);
        let sought = looking_for(&frame, 20, 5.0);
        let mut free = vec![true; 64];
        let found = |projection: Projection, free: &[bool]| search(&frame, free, &[projection], STRICT).len();
        assert_eq!(found(sought, &free), 1);
        let moved = sought.pixel + Vector2::new(6.0, 0.0);
        assert_eq!(found(Projection { pixel: moved, ..sought }, &free), 0);
        assert_eq!(found(Projection { depth: 3.0, ..sought }, &free), 0);
        assert_eq!(found(Projection { octaves: (1, 2), ..sought }, &free), 0);
        free[20] = false;
        assert_eq!(found(sought, &free), 0);
    }

    #[test]
    fn of_two_projections_the_more_similar_gets_the_feature() {
        let frame = frame_with_depth(64);
        let mut worse = looking_for(&frame, 20, 5.0);
        worse.descriptor.0[0] ^= 1 << 40;
        let projections = [worse, looking_for(&frame, 20, 5.0)];
        assert_eq!(search(&frame, &[true; 64], &projections, STRICT), vec![(20, 1)]);
    }
}
