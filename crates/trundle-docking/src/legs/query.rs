//! A docking query: start, goal, limits and region.

use crate::motion::limits::MotionLimits;
use trundle_core::{Pose2, Vector2};

/// A docking query.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DockingQuery {
    /// `map_from_base` at the start.
    pub start: Pose2,
    /// `map_from_base` at the goal.
    pub goal: Pose2,
    /// Speeds and pauses.
    pub limits: MotionLimits,
    /// Distance outside start and goal that a manoeuvre may use, m.
    pub reach: f64,
}

impl DockingQuery {
    /// Time of a turn and the following pause, s; 0 without a turn.
    pub fn turn_cost(&self, angle: f64) -> f64 {
        if angle.abs() < 1e-9 { 0.0 } else { self.limits.turn_time(angle) + self.limits.switch_time }
    }

    /// Time of a straight move and the following pause, s; 0 without a move.
    pub fn drive_cost(&self, distance: f64) -> f64 {
        if distance.abs() < 1e-9 { 0.0 } else { self.limits.drive_time(distance) + self.limits.switch_time }
    }

    /// Midpoint of start and goal, m.
    pub fn center(&self) -> Vector2 {
        (self.start.position() + self.goal.position()) / 2.0
    }

    /// Half the side of the square around [`DockingQuery::center`] that a manoeuvre may use, m.
    pub fn half(&self) -> f64 {
        self.reach + self.start.distance(&self.goal) / 2.0
    }

    /// Whether a position is in the region.
    pub fn in_region(&self, p: Vector2) -> bool {
        (p - self.center()).amax() <= self.half()
    }

    /// Longest straight move inside the region, m.
    pub fn longest(&self) -> f64 {
        2.0 * std::f64::consts::SQRT_2 * self.half()
    }
}
