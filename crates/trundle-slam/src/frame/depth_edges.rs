//! Corners on the outline of an object, which are not fixed points of a surface.

use crate::frame::aligned_feature::raw;
use crate::frame::depth::DepthConfig;
use std::f64::consts::FRAC_1_SQRT_2;
use trundle_core::{DepthImage, Vector2};
use trundle_vision::Features;

/// Radii on which the depth is compared, px of the octave: the circle of FAST, and one half as large. Source: \[Rosten06\].
const CIRCLE_RADII_PX: [f64; 2] = [1.5, 3.0];
/// Half of the directions on a circle; the others are their opposites.
const DIRECTIONS: [(f64, f64); 4] =
    [(1.0, 0.0), (FRAC_1_SQRT_2, FRAC_1_SQRT_2), (0.0, 1.0), (-FRAC_1_SQRT_2, FRAC_1_SQRT_2)];
/// Largest scale of an octave at which the radii still grow: 2. Farther out a floor meets its wall. Source: ours.
const MAX_OCTAVE_SCALE: f64 = 2.0;
/// Second difference of the inverse depth that is a step, as a fraction of it: 0.1. Source: docs/experiments/slam-depth-edges.md.
const MIN_STEP_RATIO: f64 = 0.1;
/// Second difference of the inverse depth that is a step, in standard deviations of its noise, besides the ratio: 3. Source: as
/// [`MIN_STEP_RATIO`].
const MIN_STEP_SIGMAS: f64 = 3.0;
/// Fewest features that must remain: 100. With fewer, no feature is dropped, as on railings, leaves and noisy depths. Source: ours.
const MIN_KEPT_FEATURES: usize = 100;

/// Drops the features on depth edges if enough others remain. `scale` is the size of an octave's pixel, px.
pub(crate) fn drop_depth_edges(
    features: &mut Features,
    image: &DepthImage,
    scale: impl Fn(u8) -> f64,
    config: &DepthConfig,
) {
    let keypoints = features.keypoints.iter();
    let sound: Vec<bool> =
        keypoints.map(|k| !is_on_depth_edge(image, raw(k), scale(k.octave), config)).collect();
    if sound.iter().filter(|sound| **sound).count() >= MIN_KEPT_FEATURES {
        features.retain(|i| sound[i]);
    }
}

/// Whether the depth has a step near the corner at a raw `pixel`, whose octave has pixels of `scale`.
///
/// Where the edge of a near surface crosses the background, FAST finds a corner that belongs to neither surface and slides as the camera
/// moves. The inverse depth of a plane is affine in the pixel. Its second difference is zero on a plane, small where a floor meets a wall,
/// and large across a depth edge. Directions without depth on both sides are skipped. Cost: 17 pixel reads.
fn is_on_depth_edge(image: &DepthImage, pixel: Vector2, scale: f64, config: &DepthConfig) -> bool {
    let inverse = |at: Vector2| config.at(image, at).map(|depth| 1.0 / depth);
    let middle = pixel.map(f64::round);
    let Some(here) = inverse(middle) else { return false };
    // Standard deviation of a sum of two depths and twice a third.
    let noise = 6_f64.sqrt() * config.sigma_at(1.0 / here) * here * here;
    let step = |offset: Vector2| {
        let (after, before) = (inverse(middle + offset)?, inverse(middle - offset)?);
        Some((after + before - 2.0 * here).abs())
    };
    let offsets = CIRCLE_RADII_PX.into_iter().flat_map(|radius| {
        let reach = (radius * scale.min(MAX_OCTAVE_SCALE)).max(1.0);
        DIRECTIONS.into_iter().map(move |(x, y)| Vector2::new(reach * x, reach * y).map(f64::round))
    });
    offsets.filter_map(step).any(|step| step > MIN_STEP_RATIO * here + MIN_STEP_SIGMAS * noise)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_vision::Keypoint;

    fn is_on(image: &DepthImage, x: f64, y: f64, scale: f64) -> bool {
        is_on_depth_edge(image, Vector2::new(x, y), scale, &DepthConfig::default())
    }

    #[test]
    fn a_slanted_floor_is_not_a_depth_edge_and_a_chair_before_it_is() {
        // A floor 0.45 m below a level camera; a chair leg, 2 px wide, 1.5 m away.
        let image = DepthImage::from_fn(80, 80, |x, y| {
            let floor = 0.45 * 365.0 / (y as f32 + 25.0);
            if (40..42).contains(&x) { 1.5 } else { floor }
        });
        for y in [15.0, 40.0, 60.0] {
            assert!(!is_on(&image, 20.0, y, 3.6), "the floor at row {y}");
            assert!(is_on(&image, 40.0, y, 1.0) && is_on(&image, 43.0, y, 1.0), "the leg at row {y}");
            assert!(!is_on(&image, 46.0, y, 1.0) && is_on(&image, 46.0, y, 2.0), "an octave sees farther");
        }
    }

    #[test]
    fn the_corner_of_floor_and_wall_is_not_a_depth_edge() {
        for wall in [2.0_f32, 3.0, 4.0, 5.0] {
            let image = DepthImage::from_fn(80, 120, |_, y| (0.45 * 365.0 / (y as f32 + 1e-3)).min(wall));
            let seam = (0.45 * 365.0 / f64::from(wall)).round();
            for (row, scale) in [(seam, 1.0), (seam, 3.6), (seam - 2.0, 1.7), (seam + 3.0, 2.0)] {
                assert!(!is_on(&image, 40.0, row, scale), "row {row} of a wall at {wall} m, scale {scale}");
            }
        }
    }

    #[test]
    fn a_noisy_wall_has_hardly_any_depth_edge() {
        let config = DepthConfig::default();
        for depth in [2.0, 5.0, 7.5] {
            // Sums of twelve uniform numbers: nearly normal.
            let mut state = 1_u32;
            let mut uniform = || {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 8) / f64::from(1 << 24)
            };
            let image = DepthImage::from_fn(100, 100, |_, _| {
                let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
                (depth + config.sigma_at(depth) * normal) as f32
            });
            let places = (10..90).flat_map(|y| (10..90).map(move |x| (f64::from(x), f64::from(y))));
            let on = places.filter(|&(x, y)| is_on(&image, x, y, 1.0)).count();
            assert!(on < 64, "{on} of 6400 at {depth} m");
        }
    }

    #[test]
    fn all_features_are_kept_where_few_would_be_left() {
        let blinds = DepthImage::from_fn(320, 240, |x, _| if x / 2 % 2 == 0 { 2.0 } else { 3.0 });
        let half = DepthImage::from_fn(320, 240, |x, _| if x < 160 || x / 2 % 2 == 0 { 2.0 } else { 3.0 });
        let left = |image: &DepthImage| {
            let keypoint = |i: usize| Keypoint {
                x: (10 + i % 20 * 15) as f32,
                y: (10 + i / 20 * 15) as f32,
                octave: 0,
                angle: 0.0,
                response: 1.0,
            };
            let mut features = Features {
                keypoints: (0..300).map(keypoint).collect(),
                descriptors: vec![trundle_vision::Descriptor::default(); 300],
                ..Default::default()
            };
            drop_depth_edges(&mut features, image, |_| 1.0, &DepthConfig::default());
            features.keypoints.len()
        };
        assert_eq!(left(&blinds), 300);
        assert!((MIN_KEPT_FEATURES..200).contains(&left(&half)), "{}", left(&half));
    }

    #[test]
    fn without_depth_there_is_no_depth_edge() {
        let mut image = DepthImage::filled(40, 40, 2.0);
        assert!(
            !is_on(&image, 0.0, 0.0, 3.6)
                && !is_on(&image, -9.0, 3.0, 1.0)
                && !is_on(&image, f64::NAN, 3.0, 1.0)
        );
        for row in 0..40 {
            for col in 20..40 {
                image[(col, row)] = 0.0;
            }
        }
        assert!(!is_on(&image, 19.0, 20.0, 1.0) && !is_on(&image, 21.0, 20.0, 1.0));
    }
}
