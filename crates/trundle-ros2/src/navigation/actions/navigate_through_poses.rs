//! `NavigateThroughPoses`: pose after pose, with a stop at the last one.

use super::{current_pose, duration, left, passing, refuse_behavior_tree};
use crate::generated::geometry_msgs::PoseStamped;
use crate::generated::nav2_msgs::{
    NavigateThroughPoses, NavigateThroughPosesFeedback as Feedback, NavigateThroughPosesGoal as Goal,
    NavigateThroughPosesResult as Outcome, WaypointStatus,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_reason;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_runtime::{Task, TaskEnd};

/// Distance from a pose before the last one at which the robot continues to the next \[m\]. Source: Nav2, `radius` of RemovePassedGoals in
/// `navigate_through_poses_w_replanning_and_recovery.xml`.
const PASSED_M: f64 = 0.7;

impl NavigationAction for NavigateThroughPoses {
    fn tasks(goal: &Goal, context: &GoalContext<'_>) -> Result<Vec<Task>, NavigationRefusal<Outcome>> {
        let failed = |error_code, error_msg| Outcome { error_code, error_msg, ..Outcome::default() };
        refuse_behavior_tree(&goal.behavior_tree, |message| {
            failed(Outcome::FAILED_TO_LOAD_BEHAVIOR_TREE, message)
        })?;
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

    fn feedback(goal: &Goal, view: &RunView, progress: &GoalProgress, frames: &RunFrames) -> Feedback {
        let poses = &goal.poses.goals;
        let done = view.mission.ended.len().min(poses.len());
        let next = poses.get(done).and_then(|pose| in_map(pose, frames, Some(view)).ok());
        let (distance_remaining, estimated_time_remaining) = left(view, &next.unwrap_or(view.estimate.pose));
        Feedback {
            current_pose: current_pose(view, frames),
            navigation_time: duration(progress.time_s),
            estimated_time_remaining,
            distance_remaining,
            number_of_poses_remaining: i16::try_from(poses.len() - done).unwrap_or(i16::MAX),
            waypoint_statuses: statuses(
                poses,
                view.mission.ended.iter().map(|record| (record.index, &record.end)),
            ),
            ..Feedback::default()
        }
    }

    fn result(goal: &Goal, outcome: &NavigationOutcome, _time_s: f64) -> Outcome {
        let error_code = outcome.code(Outcome::TIMEOUT, of_reason, Outcome::UNKNOWN);
        let ended = outcome.ended.iter().map(|(index, end)| (*index, end));
        let waypoint_statuses = statuses(&goal.poses.goals, ended);
        Outcome { error_code, error_msg: outcome.message.clone(), waypoint_statuses }
    }
}

/// The state of each pose, from the ends of their tasks. A pose that the robot did not come to is pending.
fn statuses<'e>(
    poses: &[PoseStamped],
    ended: impl Iterator<Item = (usize, &'e TaskEnd)>,
) -> Vec<WaypointStatus> {
    let status = |(i, pose): (usize, &PoseStamped)| WaypointStatus {
        waypoint_status: WaypointStatus::PENDING,
        waypoint_index: i as u32,
        waypoint_pose: pose.clone(),
        ..WaypointStatus::default()
    };
    let mut statuses: Vec<WaypointStatus> = poses.iter().enumerate().map(status).collect();
    for (index, end) in ended {
        let Some(status) = statuses.get_mut(index) else { continue };
        match end {
            TaskEnd::Done => status.waypoint_status = WaypointStatus::COMPLETED,
            TaskEnd::GivenUp { reason } => {
                status.waypoint_status = WaypointStatus::FAILED;
                (status.error_code, status.error_msg) = (of_reason(reason), reason.to_string());
            }
            _ => {}
        }
    }
    statuses
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::pose;
    use crate::generated::nav_msgs::Goals;
    use crate::outputs::FrameNames;
    use trundle_core::{Pose2, Stamp};
    use trundle_runtime::{NoPath, Reason};

    fn goal(count: u32, behavior_tree: &str) -> Goal {
        let pose = |x| pose::stamped(&Pose2::new(f64::from(x), 0.0, 0.0), Stamp::default(), "map");
        let goals = (0..count).map(pose).collect();
        Goal { poses: Goals { goals, ..Goals::default() }, behavior_tree: behavior_tree.to_owned() }
    }

    #[test]
    fn a_named_behavior_tree_fails() {
        let frames = RunFrames::of_own_odometry(FrameNames::default());
        let context = GoalContext { frames: &frames, view: None };
        assert_eq!(NavigateThroughPoses::tasks(&goal(2, ""), &context).unwrap().len(), 2);
        let Err(NavigationRefusal::Failed(result)) =
            NavigateThroughPoses::tasks(&goal(2, "tree.xml"), &context)
        else {
            panic!()
        };
        assert_eq!(result.error_code, 9101);
        assert!(result.error_msg.starts_with("behavior_tree is 'tree.xml'"), "{}", result.error_msg);
    }

    #[test]
    fn the_result_has_the_state_of_each_pose() {
        let reason = Reason::NoPath { cause: NoPath::GoalOutside, unseen: None };
        let mut outcome = NavigationOutcome::failed("stopped");
        outcome.ended = vec![
            (0, TaskEnd::Done),
            (1, TaskEnd::PutOff { reason: Reason::PoseUnknown }),
            (2, TaskEnd::GivenUp { reason: reason.clone() }),
            (4, TaskEnd::PutOff { reason: Reason::PoseUnknown }),
            (1, TaskEnd::Done),
        ];
        let result = NavigateThroughPoses::result(&goal(5, ""), &outcome, 1.0);
        let found: Vec<_> = result.waypoint_statuses.iter().map(|own| own.waypoint_status).collect();
        let (pending, completed, failed) =
            (WaypointStatus::PENDING, WaypointStatus::COMPLETED, WaypointStatus::FAILED);
        assert_eq!(found, [completed, completed, failed, pending, pending]);
        let missed = &result.waypoint_statuses[2];
        assert_eq!((missed.error_code, missed.waypoint_index), (204, 2));
        assert_eq!(
            (missed.error_msg.as_str(), missed.waypoint_pose.pose.position.x),
            (&*reason.to_string(), 2.0)
        );
    }
}
