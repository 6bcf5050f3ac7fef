//! Picture of a plan on its map.

use super::palette::{FORBIDDEN, GOAL, HIGH_COST, PLAN, SLOW, START, SWEPT, way_point_dots};
use crate::color::Color;
use crate::map::{DotStyle, LineStyle, MapPicture, PoseStyle};
use trundle_core::{Footprint, GridGeometry, OccupancyGrid, Pose2, Vector2};

/// Values of a mask in its cells, row by row from the lowest y, from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct MaskShares {
    /// Geometry of the cells.
    pub geometry: GridGeometry,
    /// Value of each cell.
    pub shares: Vec<f32>,
}

/// A plan to be drawn, all in the map frame, m. Empty parts are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanScene<'a> {
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// Start pose of the robot.
    pub start: Pose2,
    /// Goal poses, in order.
    pub goals: &'a [Pose2],
    /// Requested goals that were replaced by others.
    pub replaced: &'a [Pose2],
    /// The lanes of a way-point graph, end to end.
    pub lanes: &'a [[Vector2; 2]],
    /// The route of the search; empty to leave it out.
    pub route: &'a [Vector2],
    /// The way-points.
    pub way_points: &'a [Vector2],
    /// Points along the fitted curve, close together.
    pub curve: &'a [Vector2],
    /// The robot's outline.
    pub footprint: &'a Footprint,
    /// Forbidden cells (1) and costly cells (below 1).
    pub keep_out: Option<&'a MaskShares>,
    /// Slow cells: 1 minus the share of the full speed.
    pub slow: Option<&'a MaskShares>,
}

impl<'a> PlanScene<'a> {
    /// The map with the values of the masks.
    pub(super) fn ground(&self) -> MapPicture<'a> {
        let mut picture = MapPicture::over(self.grid);
        for lane in self.lanes {
            picture = picture.polyline("lane", lane, LineStyle::dashed(Color::FAINT_INK));
        }
        if let Some(mask) = self.slow {
            // Hardly slower is still to be seen.
            let shares = mask.shares.iter().map(|share| if *share > 0.0 { share.max(0.3) } else { 0.0 });
            picture = picture.tint("slow by the speed mask", mask.geometry, shares.collect(), SLOW);
        }
        if let Some(mask) = self.keep_out {
            let expensive = mask.shares.iter().map(|share| if *share < 1.0 { 0.8 * share } else { 0.0 });
            picture =
                picture.tint("high cost by the keep-out mask", mask.geometry, expensive.collect(), HIGH_COST);
        }
        self.forbidden(picture, FORBIDDEN)
    }

    /// The picture with the forbidden cells.
    pub(super) fn forbidden(&self, picture: MapPicture<'a>, color: Color) -> MapPicture<'a> {
        let Some(mask) = self.keep_out else { return picture };
        let forbidden = mask.shares.iter().map(|share| if *share >= 1.0 { 1.0 } else { 0.0 });
        picture.tint("forbidden by the keep-out mask", mask.geometry, forbidden.collect(), color)
    }

    /// The picture with start and goals, the outline about each; several goals are numbered.
    pub(super) fn ends(&self, picture: MapPicture<'a>) -> MapPicture<'a> {
        let pose = |color: Color| PoseStyle::named(color).with_footprint(self.footprint.clone());
        let asked =
            |picture: MapPicture<'a>, at: &Pose2| picture.pose("goal asked for", *at, pose(Color::FAINT_INK));
        let picture = self.replaced.iter().fold(picture, asked).pose("start", self.start, pose(START));
        let name =
            |i: usize| if self.goals.len() == 1 { "goal".to_owned() } else { format!("goal {}", i + 1) };
        let goals = self.goals.iter().enumerate();
        goals.fold(picture, |picture, (i, goal)| picture.pose(&name(i), *goal, pose(GOAL)))
    }

    /// The way-points between start and goals, which have separate marks.
    pub(super) fn between(&self) -> Vec<Vector2> {
        const SAME_POINT_M: f64 = 1e-3;
        let is_end = |p: &Vector2| {
            self.goals.iter().chain([&self.start]).any(|end| (p - end.position()).norm() < SAME_POINT_M)
        };
        self.way_points.iter().filter(|p| !is_end(p)).copied().collect()
    }
}

/// The picture of a missing plan: the map, start and goal with the robot's outline, and the reachable places `nearest` to the goal. An
/// 8-bit RGB PNG.
pub fn no_plan_picture(scene: &PlanScene, nearest: &[Vector2]) -> Vec<u8> {
    let dots = DotStyle::circles(PLAN).radius(4.0);
    scene.ends(scene.ground().dots("nearest place that can be reached", nearest, dots)).to_png()
}

/// The picture of `trundle plan`: the map, start and goal with the robot's outline, way-points, the fitted curve, and the floor swept by
/// the robot. An 8-bit RGB PNG.
pub fn plan_picture(scene: &PlanScene) -> Vec<u8> {
    let picture = scene
        .ground()
        .band("floor swept by the robot", scene.curve, scene.footprint.circumscribed_radius(), SWEPT)
        .polyline("route", scene.route, LineStyle::solid(Color::FAINT_INK).width(0.8).plain())
        .polyline("curve", scene.curve, LineStyle::solid(Color::BLUE))
        .dots("way-points", &scene.between(), way_point_dots());
    scene.ends(picture).to_png()
}
