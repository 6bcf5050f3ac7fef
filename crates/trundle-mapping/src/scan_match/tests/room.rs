//! A room without symmetry, with its scans and its map, for the matcher's tests.

use crate::filter_models::FilterModels;
use crate::particle_config::ParticleConfig;
use crate::scan_match::scan_points::ScanPoints;
use crate::units::in_cells;
use std::f64::consts::TAU;
use trundle_core::{Beam, Pose2, Scan, Stamp, Vector2};
use trundle_grid::tiles::{RayUpdateScratch, TileMap};

/// Walls as segments, m: a room of 6 x 4 m with a cupboard, a pillar and a corner cut off.
const WALLS: [[f64; 4]; 13] = [
    [-3.0, -2.0, 3.0, -2.0],
    [3.0, -2.0, 3.0, 1.0],
    [3.0, 1.0, 2.2, 2.0],
    [2.2, 2.0, -3.0, 2.0],
    [-3.0, 2.0, -3.0, -2.0],
    [-3.0, 0.5, -2.3, 0.5],
    [-2.3, 0.5, -2.3, 1.4],
    [-2.3, 1.4, -3.0, 1.4],
    [0.8, -1.2, 1.2, -1.2],
    [1.2, -1.2, 1.2, -0.9],
    [1.2, -0.9, 0.8, -0.9],
    [0.8, -0.9, 0.8, -1.2],
    [-1.0, 2.0, -1.0, 1.6],
];

/// Distance to the nearest wall along a direction, m.
fn cast(from: Vector2, angle: f64) -> f64 {
    let d = Vector2::new(angle.cos(), angle.sin());
    let meets = |[x0, y0, x1, y1]: &[f64; 4]| {
        let (a, e) = (Vector2::new(*x0, *y0), Vector2::new(x1 - x0, y1 - y0));
        let cross = |u: Vector2, v: Vector2| u.x * v.y - u.y * v.x;
        let det = cross(d, e);
        let (t, s) = (cross(a - from, e) / det, cross(a - from, d) / det);
        (det.abs() > 1e-12 && t > 0.0 && (0.0..=1.0).contains(&s)).then_some(t)
    };
    WALLS.iter().filter_map(meets).fold(f64::INFINITY, f64::min)
}

/// Scan of 360 beams around the base at `pose`.
pub(crate) fn scan(pose: Pose2) -> Scan {
    let beam = |k: usize| Beam::Hit { range: cast(pose.position(), pose.theta + k as f64 * TAU / 360.0) };
    Scan::new(Stamp::default(), Vector2::zeros(), 0.0, TAU / 360.0, (0..360).map(beam).collect()).unwrap()
}

/// Models of the default settings.
pub(crate) fn models() -> FilterModels {
    FilterModels::new(ParticleConfig::default()).unwrap()
}

/// Points of the scan at a pose.
pub(super) fn points(models: &FilterModels, pose: Pose2) -> ScanPoints {
    let mut points = ScanPoints::default();
    points.set(&models.config, &scan(pose));
    points
}

/// Map of the room from scans at several poses.
pub(super) fn map(models: &FilterModels) -> TileMap {
    let (mut map, mut scratch) = (TileMap::default(), RayUpdateScratch::default());
    for pose in [(-1.5, -1.0), (0.0, 0.0), (1.8, 0.2), (0.2, -1.5), (-0.5, 1.2), (2.2, -1.4)] {
        for k in 0..3 {
            let pose = Pose2::new(pose.0, pose.1, 0.7 * f64::from(k));
            let points = points(models, pose);
            models.ray_update.apply(&mut map, &mut scratch, in_cells(&models.config, pose), &points.rays);
        }
    }
    map
}
