//! Picture of a visual map: landmarks, keyframes and their links.

use super::palette::{ESTIMATE, GOAL, LANDMARKS, estimate_line};
use super::trajectory::principal_axes;
use crate::color::Color;
use crate::legend::LegendItem;
use crate::map::{DotStyle, LineStyle, MapPicture};
use trundle_core::{Vector2, Vector3};

/// A visual map: landmarks, keyframes, and the links between keyframes. All in one frame, m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VisualMapScene<'a> {
    /// The landmarks.
    pub landmarks: &'a [Vector3],
    /// The camera's trajectory.
    pub path: &'a [Vector3],
    /// Positions of the keyframes.
    pub keyframes: &'a [Vector3],
    /// Pairs of keyframes that see the same landmarks: the covisibility graph.
    pub covisible: &'a [(Vector3, Vector3)],
    /// Pairs of keyframes that closed a loop.
    pub loops: &'a [(Vector3, Vector3)],
}

/// The picture of a visual map, an 8-bit RGB PNG, and its legend.
///
/// The view is along the axis with the smallest motion of the camera; the axes are named. Points that are not finite are left out.
pub fn visual_map_picture(scene: &VisualMapScene) -> (Vec<u8>, Vec<LegendItem>) {
    let (right, up) = principal_axes(if is_extended(scene.path) { scene.path } else { scene.landmarks });
    let flat = |p: &Vector3| Vector2::new(p[right], p[up]);
    let points = |points: &[Vector3]| -> Vec<Vector2> { points.iter().map(flat).filter(is_finite).collect() };
    let name = |axis: usize| ["x, m", "y, m", "z, m"][axis];
    let (middle, half) = middle_of([scene.landmarks, scene.path, scene.keyframes].map(points));
    let picture = MapPicture::blank()
        .window(middle, half)
        .axes(name(right), name(up))
        .dots("landmarks", &points(scene.landmarks), DotStyle::crowd(LANDMARKS))
        .polyline(
            "covisible keyframes",
            &links(scene.covisible, flat),
            LineStyle::solid(Color::SKY.alpha(120)).width(0.5).plain(),
        )
        .polyline(
            "the camera's trajectory",
            &scene.path.iter().map(flat).collect::<Vec<_>>(),
            estimate_line(),
        )
        .dots("keyframes", &points(scene.keyframes), DotStyle::circles(ESTIMATE).radius(1.6))
        .polyline("closed loops", &links(scene.loops, flat), LineStyle::solid(GOAL).width(1.8).plain());
    (picture.clone().without_legend().to_png(), picture.legend())
}

/// Whether a camera travelled far enough, 1 m, to determine which direction is up.
fn is_extended(path: &[Vector3]) -> bool {
    let from = |a: &Vector3| path.iter().any(|b| (b - a).amax() > 1.0);
    path.iter().find(|a| a.iter().all(|v| v.is_finite())).is_some_and(from)
}

/// Part of the points at either end of each axis that the picture need not show. Source: ours.
const OUTLIER_SHARE: f64 = 0.02;

/// Middle and half side of the square that contains nearly all points.
fn middle_of(points: [Vec<Vector2>; 3]) -> (Vector2, f64) {
    let ends = |axis: usize| {
        let part = |points: &Vec<Vector2>| {
            let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
            values.sort_unstable_by(f64::total_cmp);
            let skipped = (values.len() as f64 * OUTLIER_SHARE) as usize;
            Some((*values.get(skipped)?, *values.get(values.len() - 1 - skipped)?))
        };
        let parts = points.iter().filter_map(part);
        parts.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0.0, 0.0))
    };
    let (x, y) = (ends(0), ends(1));
    let half = (x.1 - x.0).max(y.1 - y.0) / 2.0;
    (Vector2::new(x.0 + x.1, y.0 + y.1) / 2.0, 1.05 * half)
}

/// Lines between pairs of points, with gaps between them.
fn links(pairs: &[(Vector3, Vector3)], flat: impl Fn(&Vector3) -> Vector2) -> Vec<Vector2> {
    let gap = Vector2::new(f64::NAN, f64::NAN);
    pairs.iter().flat_map(|(a, b)| [flat(a), flat(b), gap]).collect()
}

fn is_finite(p: &Vector2) -> bool {
    p.x.is_finite() && p.y.is_finite()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_map_gives_a_picture_and_names_what_is_in_it() {
        let (png, _) = visual_map_picture(&VisualMapScene::default());
        assert_eq!(&png[1..4], b"PNG");
        let (a, b, nan) =
            (Vector3::new(0.0, 0.0, 0.4), Vector3::new(3.0, 1.0, 0.4), Vector3::repeat(f64::NAN));
        let scene = VisualMapScene {
            landmarks: &[a, b, nan],
            path: &[a, b],
            keyframes: &[a, b],
            covisible: &[(a, b)],
            loops: &[(a, b)],
        };
        let (png, legend) = visual_map_picture(&scene);
        assert_eq!(&png[1..4], b"PNG");
        let labels: Vec<&str> = legend.iter().map(|item| item.label.as_str()).collect();
        assert!(labels.contains(&"closed loops") && labels.contains(&"landmarks"), "{labels:?}");
    }
}
