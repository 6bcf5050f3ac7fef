//! Poses by topic and service: `goal_pose`, `initialpose`, `set_initial_pose`.

use super::active_goal::ActiveGoal;
use super::goal_pose::{GoalPoseError, in_map};
use crate::Ros2Error;
use crate::convert::pose;
use crate::generated::geometry_msgs::{PoseStamped, PoseWithCovarianceStamped};
use crate::generated::nav2_msgs::{SetInitialPose, SetInitialPoseResponse};
use crate::node::{Diagnostics, MAX_GOALS_PER_SECOND, RosNode, qos};
use crate::outputs::RunFrames;
use std::time::{Duration, Instant};
use trundle_core::Invalid;
use trundle_runtime::{OperatorCommand, PoseGuess, Task};

/// Standard deviation of a pose whose covariance is zero: position \[m\]. Source: RViz sends 0.5.
const DEFAULT_POSITION_SIGMA_M: f64 = 0.5;
/// Standard deviation of a pose whose covariance is zero: heading \[rad\]. Source: RViz sends 0.26.
const DEFAULT_HEADING_SIGMA_RAD: f64 = 0.26;

/// Subscribes to both topics and offers the service.
///
/// # Errors
/// When a topic or the service cannot be created.
pub fn offer(node: &mut RosNode, active: &ActiveGoal, frames: &RunFrames) -> Result<(), Ros2Error> {
    let (goals, own, diagnostics) = (active.clone(), frames.clone(), node.diagnostics());
    let mut limit = RateLimit::default();
    node.subscribe("goal_pose", &qos::reliable(1), None, move |goal: PoseStamped| {
        let started = if limit.is_within(Instant::now()) {
            begin(&goals, &goal, &own)
        } else {
            Err(format!("more than {MAX_GOALS_PER_SECOND} goals in a second; the rest is refused"))
        };
        started.unwrap_or_else(|why| diagnostics.warn("goal_pose", why));
    })?;
    let (guesses, own, diagnostics) = (active.clone(), frames.clone(), node.diagnostics());
    let on_guess =
        move |guess: PoseWithCovarianceStamped| set_pose(&guesses, &guess, &own, "initialpose", &diagnostics);
    node.subscribe("initialpose", &qos::reliable(1), None, on_guess)?;
    let (guesses, own, diagnostics) = (active.clone(), frames.clone(), node.diagnostics());
    node.serve::<SetInitialPose>("set_initial_pose", move |request| {
        set_pose(&guesses, &request.pose, &own, "set_initial_pose", &diagnostics);
        SetInitialPoseResponse::default()
    })
}

/// Drives to a clicked goal.
fn begin(active: &ActiveGoal, goal: &PoseStamped, frames: &RunFrames) -> Result<(), String> {
    let view = active.view();
    let pose = in_map(goal, frames, view.as_deref()).map_err(|error| match error {
        GoalPoseError::Invalid(error) => error.to_string(),
        GoalPoseError::Frame(message) => message,
    })?;
    active.begin_without_action(vec![Task::go(pose)])
}

/// Sets the robot's pose.
fn set_pose(
    active: &ActiveGoal,
    message: &PoseWithCovarianceStamped,
    frames: &RunFrames,
    name: &str,
    diagnostics: &Diagnostics,
) {
    let guess = if message.header.frame_id.trim_start_matches('/') == frames.names.map {
        guess(message).map_err(|error| error.to_string())
    } else {
        Err(format!("frame of the pose is '{}', expected {}", message.header.frame_id, frames.names.map))
    };
    let sent = guess
        .and_then(|guess| active.send(OperatorCommand::SetPose(guess)).map_err(|error| error.to_string()));
    sent.map_or_else(|why| diagnostics.warn(name, why), drop);
}

fn guess(message: &PoseWithCovarianceStamped) -> Result<PoseGuess, Invalid> {
    let pose = pose::pose2(&message.pose.pose)?;
    let covariance = pose::covariance(&message.pose.covariance, pose.theta)?;
    let or = |sigma: f64, default| if sigma > 0.0 { sigma } else { default };
    let position = ((covariance[(0, 0)] + covariance[(1, 1)]) / 2.0).sqrt();
    Ok(PoseGuess {
        pose,
        position_sigma: or(position, DEFAULT_POSITION_SIGMA_M),
        heading_sigma: or(covariance[(2, 2)].sqrt(), DEFAULT_HEADING_SIGMA_RAD),
    })
}

/// Limit of [`MAX_GOALS_PER_SECOND`] goals in a second.
#[derive(Default)]
struct RateLimit {
    since: Option<Instant>,
    count: usize,
}

impl RateLimit {
    fn is_within(&mut self, now: Instant) -> bool {
        if self.since.is_none_or(|since| now - since >= Duration::from_secs(1)) {
            *self = Self { since: Some(now), count: 0 };
        }
        self.count += 1;
        self.count <= MAX_GOALS_PER_SECOND
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Pose2, Stamp};

    #[test]
    fn a_pose_without_covariance_gets_that_of_rviz() {
        let mut message = PoseWithCovarianceStamped::default();
        message.pose.pose = pose::stamped(&Pose2::new(1.0, 2.0, 0.5), Stamp::default(), "map").pose;
        assert_eq!(guess(&message).unwrap().position_sigma, DEFAULT_POSITION_SIGMA_M);
        message.pose.covariance[0] = 0.04;
        message.pose.covariance[7] = 0.04;
        assert!((guess(&message).unwrap().position_sigma - 0.2).abs() < 1e-12);
        message.pose.covariance[0] = f64::NAN;
        assert!(guess(&message).is_err());
    }

    #[test]
    fn a_flood_of_clicks_is_limited() {
        let (mut limit, now) = (RateLimit::default(), Instant::now());
        assert_eq!((0..10_000).filter(|_| limit.is_within(now)).count(), MAX_GOALS_PER_SECOND);
        assert!(limit.is_within(now + Duration::from_secs(1)));
    }
}
