//! `NavigateThroughPoses`: pose after pose, with a stop at the last one.

use super::{current_pose, duration, left, passing};
use crate::generated::nav2_msgs::{
    NavigateThroughPoses, NavigateThroughPosesFeedback as Feedback, NavigateThroughPosesGoal as Goal,
    NavigateThroughPosesResult as Outcome, WaypointStatus,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_reason;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::FrameNames;
use trundle_app::operator::RunView;
use trundle_runtime::{Task, TaskEnd};

/// Distance from a pose before the last one at which the robot continues to the next \[m\]. Source: Nav2, `radius` of RemovePassedGoals in
/// `navigate_through_poses_w_replanning_and_recovery.xml`.
const PASSED_M: f64 = 0.7;

impl NavigationAction for NavigateThroughPoses {
    fn tasks(goal: &Goal, context: &GoalContext<'_>) -> Result<Vec<Task>, NavigationRefusal<Outcome>> {
        let failed = |error_code, error_msg| Outcome { error_code, error_msg, ..Outcome::default() };
        if goal.poses.goals.is_empty() {
            let message = "poses is empty, expected at least one".to_owned();
            return Err(NavigationRefusal::Failed(failed(Outcome::NO_VALID_WAYPOINTS, message)));
        }
        let pose = |pose| {
            in_map(pose, context.frames, context.view)
                .map_err(|error| pose_error(error, |message| failed(Outcome::TF_ERROR, message)))
        };
        let poses: Result<Vec<_>, _> = goal.poses.goals.iter().map(pose).collect();
        Ok(passing(&poses?, PASSED_M))
    }

    fn feedback(goal: &Goal, view: &RunView, progress: &GoalProgress, frames: &FrameNames) -> Feedback {
        let poses = &goal.poses.goals;
        let done = view.mission.ended.len().min(poses.len());
        let next = poses.get(done).and_then(|pose| in_map(pose, frames, Some(view)).ok());
        let (distance_remaining, estimated_time_remaining) = left(view, &next.unwrap_or(view.estimate.pose));
        let status = |(i, pose): (usize, &crate::generated::geometry_msgs::PoseStamped)| {
            let end =
                view.mission.ended.iter().rev().find(|record| record.index == i).map(|record| &record.end);
            let (waypoint_status, error_code, error_msg) = match end {
                None => (WaypointStatus::PENDING, 0, String::new()),
                Some(TaskEnd::GivenUp { reason }) => {
                    (WaypointStatus::FAILED, of_reason(reason), reason.to_string())
                }
                Some(TaskEnd::PutOff { .. }) => (WaypointStatus::PENDING, 0, String::new()),
                Some(_) => (WaypointStatus::COMPLETED, 0, String::new()),
            };
            WaypointStatus {
                waypoint_status,
                waypoint_index: i as u32,
                waypoint_pose: pose.clone(),
                error_code,
                error_msg,
            }
        };
        Feedback {
            current_pose: current_pose(view, frames),
            navigation_time: duration(progress.time_s),
            estimated_time_remaining,
            distance_remaining,
            number_of_poses_remaining: i16::try_from(poses.len() - done).unwrap_or(i16::MAX),
            waypoint_statuses: poses.iter().enumerate().map(status).collect(),
            ..Feedback::default()
        }
    }

    fn result(_goal: &Goal, outcome: &NavigationOutcome, _time_s: f64) -> Outcome {
        let error_code = outcome.code(Outcome::TIMEOUT, of_reason, Outcome::UNKNOWN);
        Outcome { error_code, error_msg: outcome.message.clone(), ..Outcome::default() }
    }
}
