//! Four corners: from an outline, then to a tenth of a pixel.

use super::components::Component;
use super::side_curve::SideCurve;
use crate::board::smooth_image::SmoothImage;
use trundle_core::Vector2;

/// Corners clockwise in the image, px.
pub(super) type Quad = [Vector2; 4];

/// Smallest side, px. Source: ours; cells of 2 px.
const MIN_SIDE_PX: f64 = 14.0;
/// Smallest ratio of the quad's area to that of the outline: blur rounds the corners of small markers. Source: ours.
const MIN_AREA_RATIO: f64 = 0.75;
/// Smallest number of dark pixels over the area: the border alone is 28 of 64 cells. Source: ours.
const MIN_DARK_RATIO: f64 = 0.25;
/// Rounds of the refinement. Source: ours; the last starts from corners that are right to half a pixel.
const SEARCH_ROUNDS: usize = 3;
/// Largest move of a corner by the refinement, over the mean side. Source: ours.
const MAX_MOVE_RATIO: f64 = 0.2;

/// The quad that an outline becomes when corners with the smallest triangles are removed; `None` if that is not a quad.
pub(super) fn outline_quad(component: &Component) -> Option<Quad> {
    let mut corners: Vec<Vector2> =
        component.hull.iter().map(|(x, y)| Vector2::new(*x as f64, *y as f64)).collect();
    let outline_area = area(&corners);
    while corners.len() > 4 {
        let n = corners.len();
        let triangle = |i: usize| area(&[corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]]);
        let smallest = (0..n).min_by(|a, b| triangle(*a).total_cmp(&triangle(*b)))?;
        corners.remove(smallest);
    }
    let quad: Quad = corners.try_into().ok()?;
    let is_large = (0..4).all(|i| (quad[(i + 1) % 4] - quad[i]).norm() >= MIN_SIDE_PX);
    let is_filled = component.pixels as f64 >= MIN_DARK_RATIO * outline_area;
    (is_large && is_filled && area(&quad) >= MIN_AREA_RATIO * outline_area).then_some(quad)
}

/// Area of a polygon, positive if it runs clockwise in the image.
fn area(corners: &[Vector2]) -> f64 {
    let n = corners.len();
    (0..n).map(|i| corners[i].perp(&corners[(i + 1) % n])).sum::<f64>() / 2.0
}

/// The corners at which curves along the edges meet; `None` if an edge is missing.
pub(super) fn refined_quad(image: &SmoothImage, start: Quad) -> Option<Quad> {
    let mut quad = start;
    for _ in 0..SEARCH_ROUNDS {
        let mut sides = Vec::with_capacity(4);
        for i in 0..4 {
            sides.push(SideCurve::fit(image, quad[i], quad[(i + 1) % 4])?);
        }
        for i in 0..4 {
            quad[i] = sides[(i + 3) % 4].end_meets_start_of(&sides[i])?;
        }
    }
    let side = area(&start).sqrt();
    let is_near = (0..4).all(|i| (quad[i] - start[i]).norm() <= MAX_MOVE_RATIO * side);
    (is_near && area(&quad) > 0.0).then_some(quad)
}
