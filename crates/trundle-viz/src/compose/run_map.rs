//! The map of a run with trajectories, plan, landmarks and ends.

use super::palette::*;
use crate::color::Color;
use crate::legend::Mark;
use crate::map::{DotStyle, MapPicture, PoseStyle};
use crate::report::Figure;
use trundle_core::{Footprint, OccupancyGrid, Pose2, Scan, Vector2, Vector3};

/// The map of a run with its overlays; empty parts and `None` are left out. Geometry is in the map frame, m.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunMap {
    /// The occupancy grid at the end.
    pub grid: Option<OccupancyGrid>,
    /// Visual landmarks; seen from above.
    pub landmarks: Vec<Vector3>,
    /// The way-points of the plan.
    pub way_points: Vec<Vector2>,
    /// Points along the fitted curve, close together.
    pub curve: Vec<Vector2>,
    /// The estimated poses of the robot.
    pub estimated_path: Vec<Pose2>,
    /// True poses of the robot.
    pub true_path: Vec<Pose2>,
    /// Start pose.
    pub start: Option<Pose2>,
    /// Goal pose.
    pub goal: Option<Pose2>,
    /// The robot's outline.
    pub footprint: Option<Footprint>,
    /// A scan and its pose (`map_from_base`).
    pub scan: Option<(Pose2, Scan)>,
}

impl RunMap {
    /// The map with all overlays, as PNG with its legend inside.
    pub fn to_png(&self) -> Vec<u8> {
        self.picture().to_png()
    }

    /// The map from above; `None` without map and path.
    pub(super) fn figure(&self) -> Option<Figure> {
        if self.grid.is_none() && self.estimated_path.is_empty() && self.true_path.is_empty() {
            return None;
        }
        let picture = self.picture();
        let figure = Figure::png("The map from above", &picture.clone().without_legend().to_png());
        let caption =
            "White: free. Black: occupied. Grey: unknown. Map frame of the robot: x to the right, y up.";
        Some(figure.legend(picture.legend()).caption(caption).wide())
    }

    fn picture(&self) -> MapPicture<'_> {
        let landmarks: Vec<Vector2> = self.landmarks.iter().map(|p| p.xy()).collect();
        let mut picture = self.ground().dots("landmarks", &landmarks, DotStyle::crowd(LANDMARKS));
        if let Some((pose, scan)) = &self.scan {
            picture = picture.scan("last scan", *pose, scan, SCAN);
        }
        picture = picture
            .polyline("planned curve", &self.curve, plan_line())
            .polyline("true path", &positions(&self.true_path), truth_line())
            .polyline("estimated path", &positions(&self.estimated_path), estimate_line())
            .dots("way-points", &self.way_points, way_point_dots());
        for (label, pose, color) in [("start", self.start, START), ("goal", self.goal, GOAL)] {
            if let Some(pose) = pose {
                picture = picture.pose(label, pose, self.pose_style(color));
            }
        }
        picture
    }

    /// Detail of the goal: true and estimated outline at the end.
    pub(super) fn goal_figure(&self) -> Option<Figure> {
        let goal = self.goal.filter(Pose2::is_finite)?;
        let footprint = self.footprint.clone().unwrap_or(Footprint::KOBUKI);
        let end = |path: &[Pose2]| path.iter().rev().find(|pose| pose.is_finite()).copied();
        let ends = |path: &[Pose2]| end(path).into_iter().collect::<Vec<_>>();
        let picture = self
            .ground()
            .polyline("true path", &positions(&self.true_path), truth_line())
            .polyline("estimated path", &positions(&self.estimated_path), estimate_line())
            .pose("goal", goal, self.pose_style(GOAL).nameless())
            .outlines("true end", &ends(&self.true_path), &footprint, TRUTH)
            .outlines("estimated end", &ends(&self.estimated_path), &footprint, ESTIMATE)
            .window(goal.position(), 1.7 * footprint.circumscribed_radius())
            .lettering(1.75);
        let png = picture.clone().without_legend().to_png();
        let legend = picture.legend().into_iter().filter(|item| item.mark != Mark::Cell).collect();
        let caption = "The robot's outline at the goal and at its end; a stroke shows the heading.";
        Some(Figure::png("The goal from near", &png).legend(legend).caption(caption))
    }

    fn ground(&self) -> MapPicture<'_> {
        self.grid.as_ref().map_or_else(MapPicture::blank, MapPicture::over)
    }

    fn pose_style(&self, color: Color) -> PoseStyle {
        PoseStyle { footprint: self.footprint.clone(), ..PoseStyle::named(color) }
    }
}

fn positions(poses: &[Pose2]) -> Vec<Vector2> {
    poses.iter().map(Pose2::position).collect()
}
