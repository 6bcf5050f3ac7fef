//! Input and report of a step of the positioner.

use crate::docking_plan::DockingRefusal;
use crate::motion::manoeuvre::Motion;
use crate::scene::blocker::Blocker;
use crate::scene::obstacle_scene::ObstacleScene;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Stamp, Twist2};

/// Input of a step.
#[derive(Debug, Clone, Copy)]
pub struct PositionerInput<'a> {
    /// Time of the step.
    pub stamp: Stamp,
    /// The measured `map_from_base`.
    pub pose: Pose2,
    /// Covariance of the pose (x m, y m, heading rad), right perturbation; it determines the margin.
    pub covariance: Matrix3<f64>,
    /// Obstacles now, map frame.
    pub scene: &'a ObstacleScene,
}

/// Reason for a command.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum PositionerReason {
    /// The robot is at rest, and its pose is averaged.
    Measuring,
    /// The robot is at rest, and a manoeuvre is planned with `PositionerConfig::step_work` per step.
    Planning,
    /// Carrying out a motion.
    Moving(Motion),
    /// The robot is at the goal, within tolerance.
    Settled,
    /// An obstacle blocks the motion, or a new plan: stopped, and planning again from here.
    Obstacle(Blocker),
    /// No manoeuvre exists; planned again after a wait.
    NoWay(Option<Blocker>),
    /// The query cannot be planned; tried again after a wait.
    Refused(DockingRefusal),
    /// The pose is not finite.
    BadPose,
}

/// Result of a step.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionerReport {
    /// The twist to command.
    pub twist: Twist2,
    /// The reason.
    pub reason: PositionerReason,
    /// `goal_from_base`: the error, of the averaged pose while at rest.
    pub error: Pose2,
}
