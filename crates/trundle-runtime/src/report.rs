//! The report of a step.

use crate::{behaviour::drive_state::DriveState, checkpoint::Checkpoint, reason::TransitionReason};
use std::sync::Arc;
use trundle_core::{PoseEstimate, Stamp, Twist2};
use trundle_estimation::{MotionIncrement, PlanarMeasurement, VisualPose};
use trundle_slam::TrackReport;

/// Report of one step of the robot.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct StepReport {
    /// The command for the base, on control steps.
    pub twist: Option<Twist2>,
    /// The pose estimate after the step.
    pub estimate: Option<PoseEstimate>,
    /// Whether the pose is too uncertain to drive, or unknown.
    pub pose_is_lost: bool,
    /// Stamp of the image that was processed in this step, or whose result was applied.
    pub image: Option<Stamp>,
    /// Reason why the image cannot be decoded.
    pub broken_image: Option<String>,
    /// Report of the visual tracker, on images.
    pub track: Option<TrackReport>,
    /// Measurements that the estimate received in this step.
    pub measurements: PoseMeasurements,
    /// A checkpoint, every 3 to 10 s, after [`crate::Robot::with_checkpoints`].
    pub checkpoint: Option<Arc<Checkpoint>>,
    /// State of the robot.
    pub state: DriveState,
    /// Reason for the last change of the state; `None` before the first change, and after the end of the mission.
    pub transition: Option<TransitionReason>,
    /// Whether the step made a new plan.
    pub replanned: bool,
    /// Whether an operator's command replaced the map.
    pub map_replaced: bool,
    /// Whether an operator's command dropped the rest of the mission.
    pub mission_replaced: bool,
    /// Whether the mission is over; `state` then holds its outcome.
    pub finished: bool,
}

/// Measurements that the pose estimate received in a step, for a second estimator.
#[derive(Debug, Clone, Default)]
pub struct PoseMeasurements {
    /// Motion by wheels and gyro.
    pub motion: Option<MotionIncrement>,
    /// Visual pose.
    pub visual: Option<VisualPose>,
    /// Scan match.
    pub scan: Option<PlanarMeasurement>,
}
