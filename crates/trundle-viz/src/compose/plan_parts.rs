//! Pictures of the steps of a plan: distance field, grid path, corridors and curve.

use super::palette::{FORBIDDEN, PLAN, way_point_dots};
use super::plan::PlanScene;
use crate::chart::Chart;
use crate::color::Color;
use crate::map::{DotStyle, LineStyle, MapPicture};
use trundle_core::{GridGeometry, Trajectory, Vector2};

/// Parts of a plan in addition to [`PlanScene`]; map frame, m. Empty parts are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanParts<'a> {
    /// Geometry of the distance field's cells.
    pub geometry: GridGeometry,
    /// Distance to the nearest obstacle, m, row by row from the lowest y.
    pub distances: &'a [f32],
    /// The corners of the convex corridors.
    pub corridors: &'a [Vec<Vector2>],
    /// Control points that lean on a corridor's side.
    pub active: &'a [Vector2],
}

/// Largest distance with a separate colour, m. Source: ours.
const MAX_SHOWN_DISTANCE_M: f32 = 1.0;

/// The pictures of a plan's stages: the distance field with the path of the search, and the corridors with the curve fitted into them.
/// 8-bit RGB PNGs.
pub fn plan_part_pictures(scene: &PlanScene, parts: &PlanParts) -> [Vec<u8>; 2] {
    let free = |distance: &f32| if *distance > 0.0 { *distance } else { f32::NAN };
    let distances = parts.distances.iter().map(free).collect();
    let shaded = MapPicture::over(scene.grid).shade(
        "distance to the nearest obstacle, dark from 1 m on",
        parts.geometry,
        distances,
        MAX_SHOWN_DISTANCE_M,
    );
    let field = scene
        .forbidden(shaded, FORBIDDEN.alpha(255))
        .polyline("route", scene.route, LineStyle::dashed(Color::BLACK).width(1.0))
        .polyline("way", scene.way_points, LineStyle::solid(PLAN))
        .dots("way-points", &scene.between(), way_point_dots());
    let corridors = scene
        .ground()
        .polyline("corridors", &outlines(parts.corridors), LineStyle::solid(Color::ORANGE).width(0.8).plain())
        .polyline("curve", scene.curve, LineStyle::solid(Color::BLUE))
        .dots("way-points", &scene.between(), way_point_dots())
        .dots("active constraints", parts.active, DotStyle::circles(Color::VERMILLION).radius(3.6));
    [field, corridors].map(|picture| scene.ends(picture).to_png())
}

/// Speed and turn rate over time, with the drive's limits (m/s, rad/s).
pub fn speed_charts(trajectory: &Trajectory, limits: (f64, f64)) -> [Chart; 2] {
    let over_time = |of: fn(&trundle_core::TrajectoryPoint) -> f64| -> Vec<(f64, f64)> {
        trajectory.points().iter().map(|point| (point.time, of(point))).collect()
    };
    let speed = Chart::new("Speed", "time, s", "speed, m/s")
        .line("speed", Color::BLUE, over_time(|point| point.twist.v))
        .limit("limit", limits.0);
    let turning = Chart::new("Turn rate", "time, s", "turn rate, rad/s")
        .line("turn rate", Color::ORANGE, over_time(|point| point.twist.omega))
        .limit("limit", limits.1)
        .limit("limit to the right", -limits.1);
    [speed, turning]
}

/// Closed outlines, with gaps between them.
fn outlines(polygons: &[Vec<Vector2>]) -> Vec<Vector2> {
    let gap = Vector2::repeat(f64::NAN);
    polygons.iter().flat_map(|corners| corners.iter().chain(corners.first()).copied().chain([gap])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compose::MaskShares;
    use trundle_core::{Footprint, OccupancyGrid, Pose2, TrajectoryPoint, Twist2};

    #[test]
    fn parts_are_drawn_and_nothing_does_not_panic() {
        let grid = OccupancyGrid::from_ascii(0.1, "#####\n#...#\n#...#\n#####").unwrap();
        let path = [Vector2::new(0.15, 0.15), Vector2::new(0.35, 0.25)];
        let mask = MaskShares { geometry: *grid.geometry(), shares: vec![0.4; 20] };
        let scene = PlanScene {
            grid: &grid,
            start: Pose2::new(0.15, 0.15, 0.0),
            goals: &[Pose2::new(0.35, 0.25, 0.0)],
            replaced: &[],
            lanes: &[],
            route: &path,
            way_points: &path,
            curve: &path,
            footprint: &Footprint::KOBUKI,
            keep_out: Some(&mask),
            slow: Some(&mask),
        };
        let parts = |distances, corridors| PlanParts {
            geometry: *grid.geometry(),
            distances,
            corridors,
            active: &path,
        };
        let triangle = [vec![path[0], path[1], Vector2::new(0.3, 0.1)]];
        let full = plan_part_pictures(&scene, &parts(&[0.1; 20], &triangle));
        let bare = plan_part_pictures(&scene, &parts(&[], &[]));
        assert!(full.iter().zip(&bare).all(|(full, bare)| full != bare && full[1..4] == *b"PNG"));
        let point =
            |time: f64| TrajectoryPoint { time, pose: Pose2::IDENTITY, twist: Twist2::new(time, 0.1) };
        let trajectory = Trajectory::new(vec![point(0.0), point(0.5)]).unwrap();
        let [speed, turning] = speed_charts(&trajectory, (0.7, 1.9)).map(|chart| chart.to_svg());
        assert!(speed.contains("Speed") && turning.contains("Turn rate"));
    }
}
