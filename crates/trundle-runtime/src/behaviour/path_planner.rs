//! Plans paths within the zones, along which the camera observes the floor ahead in time.

pub(crate) mod camera_fov;
pub(crate) mod known_floor;
mod plan_in_view;
pub(crate) mod visibility_constraint;

use crate::config::RobotConfig;
use crate::reason::{NoPath, Reason};
use crate::world_state::WorldState;
use camera_fov::CameraFov;
pub(crate) use plan_in_view::{InView, UnseenPath};
use trundle_core::{Cell, Footprint, Invalid, Pose2, Twist2, Vector2};
use trundle_planning::{Plan, Planner};
use visibility_constraint::VisibilityConstraint;

/// The planner with the camera's field of view, the unseen floor and the zones.
#[derive(Debug)]
pub(crate) struct PathPlanner {
    pub(crate) planner: Planner,
    /// The camera's field of view on the floor; none with a laser as range source.
    pub(crate) camera_fov: Option<CameraFov>,
    pub(crate) visibility: VisibilityConstraint,
    /// Radius of the disc around the robot, m.
    radius: f64,
    /// Version of the zones that the planner has.
    zones_version: u64,
}

impl PathPlanner {
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            planner: Planner::new(config.planning, footprint, config.limits, config.drive)?,
            camera_fov: CameraFov::of(config)?,
            visibility: VisibilityConstraint::default(),
            radius: footprint.circumscribed_radius(),
            zones_version: 0,
        })
    }

    /// Takes the limits of changed zones. Returns whether the zones have changed.
    pub(crate) fn take_zones(&mut self, s: &WorldState<'_>) -> bool {
        let Some(masks) = s.zones.masks.filter(|_| self.has_other_zones(s)) else { return false };
        self.zones_version = masks.version;
        self.planner.set_speed_mask(masks.speeds.clone());
        self.planner.set_cost_mask(masks.costs.clone());
        true
    }

    /// Version of the zones that the planner has.
    pub(crate) fn zones_version(&self) -> u64 {
        self.zones_version
    }

    /// Whether the zones differ from those of the planner.
    pub(crate) fn has_other_zones(&self, s: &WorldState<'_>) -> bool {
        s.zones.masks.is_some_and(|masks| masks.version != self.zones_version)
    }

    /// A path from a pose and twist among the dynamic obstacles.
    pub(crate) fn plan_among_moving(
        &mut self,
        s: &WorldState<'_>,
        (from, twist): (Pose2, Twist2),
        goal: Pose2,
    ) -> Plan {
        let (floor, movers) = (s.permitted_floor(), s.dynamic_obstacles.movers);
        self.planner.plan_among_moving(floor, movers, from, twist, goal)
    }

    /// Whether only moving obstacles block the path.
    pub(crate) fn is_free_but_for_movers(
        &mut self,
        s: &WorldState<'_>,
        from: (Pose2, Twist2),
        goal: Pose2,
    ) -> bool {
        !s.dynamic_obstacles.movers.is_empty()
            && matches!(self.planner.plan(s.permitted_floor(), from.0, from.1, goal), Plan::Found(_))
    }

    /// The point nearest to the goal that the robot reaches over seen floor alone, map frame, m; `None` if a path over seen floor leads to the
    /// goal.
    pub(crate) fn nearest_seen_point(&mut self, s: &WorldState<'_>, goal: Pose2) -> Option<Vector2> {
        let mut seen = s.permitted_floor().clone();
        let geometry = *seen.geometry();
        // The goal itself may be out of sight.
        let around_goal = self.radius + 2.0 * geometry.resolution;
        for cell in (0..geometry.len()).map(|k| geometry.cell(k)) {
            let is_off = (geometry.center(cell) - goal.position()).norm() > around_goal;
            if is_off && seen.get(cell) == Cell::Unknown {
                seen.set(cell, Cell::Occupied);
            }
        }
        match self.planner.plan(&seen, s.estimate.pose, Twist2::ZERO, goal) {
            Plan::Blocked { nearest } => Some(nearest),
            _ => None,
        }
    }

    /// The reason for a missing path, with the floor excluded from the search.
    pub(crate) fn no_path(&self, cause: NoPath) -> Reason {
        Reason::NoPath { cause, unseen: self.visibility.keep_out() }
    }
}
