//! Goal poses of messages in the map frame.

use crate::convert::pose;
use crate::generated::geometry_msgs::PoseStamped;
use crate::outputs::FrameNames;
use trundle_app::operator::RunView;
use trundle_core::{Invalid, Pose2};

/// Reason why a goal pose is refused.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum GoalPoseError {
    /// A number is invalid: the goal is refused.
    Invalid(Invalid),
    /// The frame of the pose is unknown: the goal fails.
    Frame(String),
}

/// A goal pose in the map frame. Poses in the frames of odometry and base are moved by the estimate of `view`.
///
/// # Errors
/// When a number is not finite, the rotation was never set, or the frame is not that of map, odometry or base.
pub fn in_map(
    goal: &PoseStamped,
    frames: &FrameNames,
    view: Option<&RunView>,
) -> Result<Pose2, GoalPoseError> {
    let pose = pose::pose2(&goal.pose).map_err(GoalPoseError::Invalid)?;
    let frame = goal.header.frame_id.trim_start_matches('/');
    if frame == frames.map {
        return Ok(pose);
    }
    let unknown = || {
        let FrameNames { map, odom, base, .. } = frames;
        GoalPoseError::Frame(format!("frame of the goal is '{frame}', expected {map}, {odom} or {base}"))
    };
    let view = view.ok_or_else(unknown)?;
    match (frame == frames.odom, frame == frames.base, view.odometry) {
        (true, _, Some(odometry)) => Ok(view.estimate.pose * odometry.pose.inverse() * pose),
        (_, true, _) => Ok(view.estimate.pose * pose),
        _ => Err(unknown()),
    }
}
