//! A corner to a tenth of a pixel.
//!
//! Each pixel near a corner is on an edge through the corner, with its gradient across the edge, or in a flat area with gradient zero:
//! `gradient . (pixel - corner) = 0`. Weighted least squares gives the corner \[Geiger12, eq. 4\].

use super::smooth_image::SmoothImage;
use nalgebra::Matrix2;
use trundle_core::Vector2;

/// Rounds. Source: ours; the corner moves by less than 0.001 px after ten.
const MAX_ROUND_COUNT: usize = 20;
/// Step below which the corner has converged, px. Source: ours.
const CONVERGED_PX: f64 = 1e-3;

/// The corner near `start`, by the pixels within `radius` px; `None` if it is farther than `radius` px from the start.
pub(super) fn refine_corner(image: &SmoothImage, start: Vector2, radius: f64) -> Option<Vector2> {
    let mut corner = start;
    for _ in 0..MAX_ROUND_COUNT {
        if !image.contains(corner, radius + 2.0) {
            return None;
        }
        let next = one_round(image, corner, radius)?;
        let moved = (next - corner).norm();
        corner = next;
        if (corner - start).norm() > radius {
            return None;
        }
        if moved < CONVERGED_PX {
            break;
        }
    }
    Some(corner)
}

fn one_round(image: &SmoothImage, corner: Vector2, radius: f64) -> Option<Vector2> {
    let steps = radius.floor() as i64;
    let (mut information, mut vector) = (Matrix2::zeros(), Vector2::zeros());
    for dy in -steps..=steps {
        for dx in -steps..=steps {
            let offset = Vector2::new(dx as f64, dy as f64);
            let weight = (-2.0 * offset.norm_squared() / (radius * radius)).exp();
            let gradient = image.gradient(corner + offset);
            let outer = gradient * gradient.transpose() * weight;
            information += outer;
            vector += outer * (corner + offset);
        }
    }
    information.try_inverse().map(|inverse| inverse * vector)
}
