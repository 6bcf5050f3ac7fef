//! The report of a step.

use crate::{behaviour::drive_state::DriveState, checkpoint::Checkpoint};
use std::sync::Arc;
use trundle_core::{PoseEstimate, Stamp, Twist2};
use trundle_slam::TrackReport;

/// What one step of the robot tells the outside.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct StepReport {
    /// The command for the base, on control steps.
    pub twist: Option<Twist2>,
    /// The pose estimate after the step.
    pub estimate: Option<PoseEstimate>,
    /// Stamp of the image that was looked at, here or, when what it showed is taken up, in the background.
    pub image: Option<Stamp>,
    /// Why an image that was looked at was none.
    pub broken_image: Option<String>,
    /// What the visual tracker said, on images.
    pub track: Option<TrackReport>,
    /// What the robot would take along through a restart, now and then, where it remembers ([`crate::Robot::remembering`]).
    pub memory: Option<Arc<Checkpoint>>,
    /// What the robot is doing.
    pub state: DriveState,
    /// Whether the step made a new plan.
    pub replanned: bool,
    /// Whether the mission is over: then `state` says how it ended.
    pub finished: bool,
}
