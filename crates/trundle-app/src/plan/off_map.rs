//! Distance by which the robot's outline leaves the map along a plan: space outside the map is unknown.

use super::request::PlanRequest;
use trundle_core::{Footprint, GridGeometry, Pose2, Vector2};
use trundle_planning::MultiGoalPlan;

/// Distance beyond the map's edge \[m\]. Up to it the outline counts as on the map. Source: ours.
const MAX_IGNORED_DISTANCE_M: f64 = 0.005;

/// Distance of two poses of the curve that are checked \[m\]. Source: ours.
const POSE_SPACING_M: f64 = 0.02;

/// The place of a plan at which the robot's outline is farthest outside the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffMap {
    /// Distance of the outermost point of the outline from the map's edge, m.
    pub by: f64,
    /// Pose of the base at this place, map frame.
    pub at: Pose2,
}

impl OffMap {
    /// The place at which the outline is farthest outside the map along the plan; `None` if the outline stays on the map.
    #[must_use]
    pub fn of(request: &PlanRequest, plan: &MultiGoalPlan) -> Option<Self> {
        let geometry = request.grid.geometry();
        let poses = poses(request, plan).into_iter();
        let off = poses.map(|at| Self { by: distance_off(geometry, &request.footprint, &at), at });
        off.max_by(|a, b| a.by.total_cmp(&b.by)).filter(|off| off.by > MAX_IGNORED_DISTANCE_M)
    }

    /// The warning in one sentence.
    #[must_use]
    pub fn warning(&self) -> String {
        let Self { by, at } = self;
        format!(
            "the robot's outline leaves the map by up to {by:.2} m, with the base at ({:.2}, {:.2}) m: what is off the map is unknown, and \
             planning.unknown takes that for free; --set planning.unknown=obstacle keeps the robot on the map, as `trundle dock` does",
            at.x, at.y
        )
    }
}

/// Poses along all curves, close together, and both ends.
fn poses(request: &PlanRequest, plan: &MultiGoalPlan) -> Vec<Pose2> {
    let curves = plan.legs.iter().flat_map(|leg| leg.curves());
    let along = curves.flat_map(|curve| curve.samples(POSE_SPACING_M)).map(|sample| sample.pose);
    along.chain([request.start.pose, plan.trajectory.end()]).collect()
}

/// Distance by which the outline at a pose reaches beyond the map, m; below 0 inside.
fn distance_off(geometry: &GridGeometry, footprint: &Footprint, pose: &Pose2) -> f64 {
    let beyond = |point: Vector2, reach: f64| {
        let size = Vector2::new(geometry.width as f64, geometry.height as f64) * geometry.resolution;
        let (below, above) = (geometry.origin - point, point - geometry.origin - size);
        below.max().max(above.max()) + reach
    };
    match footprint {
        Footprint::Disc { radius } => beyond(pose.position(), *radius),
        Footprint::Polygon { corners } => corners
            .iter()
            .map(|corner| beyond(pose.transform(*corner), 0.0))
            .fold(f64::NEG_INFINITY, f64::max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_at_the_edge_are_off_the_map_by_what_is_beyond_it() {
        let geometry = GridGeometry::new(0.1, Vector2::new(-1.0, 0.0), 20, 10).unwrap();
        let disc = Footprint::disc(0.2).unwrap();
        let off = |footprint: &Footprint, x, y| distance_off(&geometry, footprint, &Pose2::new(x, y, 0.0));
        assert!((off(&disc, 0.0, 0.05) - 0.15).abs() < 1e-9);
        assert!((off(&disc, 0.95, 0.5) - 0.15).abs() < 1e-9);
        assert!(off(&disc, 0.0, 0.5) < 0.0);
        let corners = [(0.3, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.3, -0.1)].map(|(x, y)| Vector2::new(x, y));
        let polygon = Footprint::polygon(corners.to_vec()).unwrap();
        assert!((off(&polygon, 0.9, 0.5) - 0.2).abs() < 1e-9);
        assert!(off(&polygon, -0.9, 0.5) < 1e-9);
    }
}
