use super::palette::{GOAL, START, SWEPT, way_point_dots};
use crate::color::Color;
use crate::map::{LineStyle, MapPicture, PoseStyle};
use trundle_core::{Footprint, OccupancyGrid, Pose2, Vector2};

/// A plan to be drawn, all in the map frame, m. What is empty is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanScene<'a> {
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// Where the robot stands.
    pub start: Pose2,
    /// Where it is to stand.
    pub goal: Pose2,
    /// The route as the search found it; pass none to leave it out.
    pub route: &'a [Vector2],
    /// The way-points.
    pub way_points: &'a [Vector2],
    /// Points along the fitted curve, close together.
    pub curve: &'a [Vector2],
    /// The robot's outline.
    pub footprint: &'a Footprint,
}

/// The picture of `trundle plan`: the map, start and goal with the robot's outline, way-points, the fitted curve, and the
/// floor the robot sweeps along it. An 8-bit RGB PNG.
pub fn plan_picture(scene: &PlanScene) -> Vec<u8> {
    let pose = |color: Color| PoseStyle::named(color).with_footprint(scene.footprint.clone());
    MapPicture::over(scene.grid)
        .band("floor swept by the robot", scene.curve, scene.footprint.circumscribed_radius(), SWEPT)
        .polyline("route", scene.route, LineStyle::solid(Color::FAINT_INK).width(0.8).plain())
        .polyline("curve", scene.curve, LineStyle::solid(Color::BLUE))
        .dots("way-points", scene.way_points, way_point_dots())
        .pose("start", scene.start, pose(START))
        .pose("goal", scene.goal, pose(GOAL))
        .to_png()
}
