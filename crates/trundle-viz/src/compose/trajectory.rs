//! Picture of an estimated trajectory with the true one.

use super::palette::{estimate_line, truth_line};
use crate::color::Color;
use crate::map::{DotStyle, LineStyle, MapPicture};
use trundle_core::{Vector2, Vector3};

/// Largest number of lines between estimate and truth. Source: ours.
const MAX_ERROR_LINES: usize = 400;

/// The picture of `trundle slam`: a trajectory, and the true one if given, both in the same frame (aligned), m.
///
/// The view is along the axis with the smallest motion, which shows the two main axes; the axes are named. If both have the same number of
/// points, a thin grey line connects point i of one with point i of the other: its length is the error. Positions that are not finite
/// interrupt the line. An 8-bit RGB PNG.
pub fn trajectory_picture(estimate: &[Vector3], truth: Option<&[Vector3]>) -> Vec<u8> {
    let truth = truth.unwrap_or_default();
    let (right, up) = principal_axes(if truth.is_empty() { estimate } else { truth });
    let flat = |points: &[Vector3]| -> Vec<Vector2> {
        points.iter().map(|p| Vector2::new(p[right], p[up])).collect()
    };
    let (estimate, truth) = (flat(estimate), flat(truth));
    let ends = |points: &[Vector2], last: bool| {
        let mut finite = points.iter().copied().filter(|p| p.x.is_finite() && p.y.is_finite());
        if last { finite.next_back() } else { finite.next() }.into_iter().collect::<Vec<_>>()
    };
    let name = |axis: usize| ["x, m", "y, m", "z, m"][axis];
    MapPicture::blank()
        .axes(name(right), name(up))
        .polyline("error", &ties(&estimate, &truth), LineStyle::solid(Color::FAINT_INK).width(0.5).plain())
        .polyline("true trajectory", &truth, truth_line())
        .polyline("estimated trajectory", &estimate, estimate_line())
        .dots("start", &ends(&estimate, false), DotStyle::circles(Color::GREEN).radius(3.6))
        .dots("end", &ends(&estimate, true), DotStyle::circles(Color::VERMILLION).radius(3.6))
        .to_png()
}

/// The two axes along which the points spread most, in the order x, y, z. Standing still is seen from above.
pub(super) fn principal_axes(points: &[Vector3]) -> (usize, usize) {
    let spread = |axis: usize| {
        let finite = || points.iter().map(|p| p[axis]).filter(|v| v.is_finite());
        finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min)
    };
    let [x, y, z] = [spread(0), spread(1), spread(2)];
    if z <= x.min(y) {
        (0, 1)
    } else if y <= x {
        (0, 2)
    } else {
        (1, 2)
    }
}

/// Lines from each estimated to its true position, with gaps between them.
fn ties(estimate: &[Vector2], truth: &[Vector2]) -> Vec<Vector2> {
    if estimate.len() != truth.len() {
        return Vec::new();
    }
    let gap = Vector2::new(f64::NAN, f64::NAN);
    let stride = estimate.len().div_ceil(MAX_ERROR_LINES).max(1);
    estimate.iter().zip(truth).step_by(stride).flat_map(|(a, b)| [*a, *b, gap]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flattest_axis_is_looked_along() {
        let points = |scale: [f64; 3]| -> Vec<Vector3> {
            (0..9).map(|i| Vector3::new(scale[0], scale[1], scale[2]) * f64::from(i)).collect()
        };
        assert_eq!(principal_axes(&points([1.0, 2.0, 0.1])), (0, 1));
        assert_eq!(principal_axes(&points([1.0, 0.1, 2.0])), (0, 2));
        assert_eq!(principal_axes(&points([0.1, 1.0, 2.0])), (1, 2));
        assert_eq!(principal_axes(&[]), (0, 1));
    }

    #[test]
    fn any_trajectory_gives_a_picture() {
        let nan = Vector3::new(f64::NAN, 0.0, 0.0);
        for (estimate, truth) in
            [(vec![], None), (vec![nan], Some(vec![nan])), (vec![Vector3::zeros()], Some(vec![]))]
        {
            assert_eq!(&trajectory_picture(&estimate, truth.as_deref())[1..4], b"PNG");
        }
    }
}
