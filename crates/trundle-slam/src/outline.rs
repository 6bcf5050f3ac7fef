//! Corners on the outline of something, which are no point of anything.

use crate::depth::DepthConfig;
use std::f64::consts::FRAC_PI_4;
use trundle_core::{DepthImage, Vector2};

/// The circle of FAST around a corner, px of its octave \[Rosten06\], and one half as large: what made it one is within.
const CIRCLES: [f64; 2] = [1.5, 3.0];
/// Second differences of the inverse depth beyond this part of it are a step: swept in docs/results.md.
const STEP: f64 = 0.1;

/// Whether the depth steps within what makes the corner at a raw `pixel`, whose octave has pixels of `scale`.
///
/// Where the outline of something near crosses what is behind it, or leaves it, FAST sees a corner that neither of the two has: it
/// slides along as the camera moves. The inverse depth of a plane is affine in the pixel, so that its second difference vanishes on
/// every surface however steep, and not across an outline. Where there is no depth on both sides, nothing is said. Cost: 17 looks.
pub(crate) fn is_on_outline(image: &DepthImage, pixel: Vector2, scale: f64, config: &DepthConfig) -> bool {
    let inverse = |at: Vector2| config.at(image, at).map(|depth| 1.0 / depth);
    let middle = pixel.map(f64::round);
    let Some(here) = inverse(middle) else { return false };
    let step = |offset: Vector2| {
        let (after, before) = (inverse(middle + offset)?, inverse(middle - offset)?);
        Some((after + before - 2.0 * here).abs())
    };
    let offsets = CIRCLES.into_iter().flat_map(|radius| {
        let reach = (radius * scale).max(1.0);
        (0..4).map(move |i| {
            let (sin, cos) = (f64::from(i) * FRAC_PI_4).sin_cos();
            Vector2::new(reach * cos, reach * sin).map(f64::round)
        })
    });
    offsets.filter_map(step).any(|step| step > STEP * here)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_on(image: &DepthImage, x: f64, y: f64, scale: f64) -> bool {
        is_on_outline(image, Vector2::new(x, y), scale, &DepthConfig::default())
    }

    #[test]
    fn a_floor_seen_flat_is_no_outline_and_a_chair_before_it_is() {
        // A floor 0.45 m below a camera that looks level; a chair leg, 2 px wide, 1.5 m away.
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
    fn where_there_is_no_depth_nothing_is_said() {
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
