//! Segments of a path with their corridors, and constraints on the ends of a curve.

use crate::curve::corridor::corridor;
use crate::curve::fit::config::CurveConfig;
use crate::curve::half_plane::HalfPlane;
use crate::search::configuration_space::ConfigurationSpace;
use trundle_core::Vector2;

/// Constraint on the tangent at an end of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Tangent {
    /// Any forward direction.
    Free,
    /// A heading, rad, forward.
    Heading(f64),
    /// This heading, rad, at unit parametric speed, and this curvature, 1/m: the continuation of a motion.
    Moving(f64, f64),
}

/// A straight segment of the path with its corridor; one piece of the curve follows the segment.
pub(crate) struct PathSegment {
    pub(crate) from: Vector2,
    pub(crate) to: Vector2,
    pub(crate) planes: Vec<HalfPlane>,
}

impl PathSegment {
    pub(crate) fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }
}

/// Cuts a path into segments of at most `config.piece` m and finds their corridors.
pub(crate) fn segments(
    space: &ConfigurationSpace<'_>,
    path: &[Vector2],
    config: &CurveConfig,
) -> Vec<PathSegment> {
    let want = space.radius + space.costs.margin;
    let mut segments = Vec::new();
    for pair in path.windows(2) {
        let count = ((pair[1] - pair[0]).norm() / config.piece).ceil().max(1.0);
        let at = |k: f64| pair[0] + (pair[1] - pair[0]) * (k / count);
        for k in 0..count as usize {
            let (from, to) = (at(k as f64), at(k as f64 + 1.0));
            let planes = corridor(space, from, to, config.reach, want);
            segments.push(PathSegment { from, to, planes });
        }
    }
    segments
}
