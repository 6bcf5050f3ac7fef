//! `FollowWaypoints`: poses in loops; missed ones are listed.

use crate::generated::nav2_msgs::{
    FollowWaypoints, FollowWaypointsFeedback as Feedback, FollowWaypointsGoal as Goal,
    FollowWaypointsResult as Outcome, WaypointStatus,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_reason;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_runtime::Task;

/// Largest number of way-points, over all loops. Source: ours; a day at one in 10 s.
const MAX_WAYPOINTS: usize = 10_000;

impl NavigationAction for FollowWaypoints {
    fn tasks(goal: &Goal, context: &GoalContext<'_>) -> Result<Vec<Task>, NavigationRefusal<Outcome>> {
        let failed =
            |error_msg| Outcome { error_code: Outcome::NO_VALID_WAYPOINTS, error_msg, ..Outcome::default() };
        let loops = 1 + goal.number_of_loops as usize;
        let count = goal.poses.len().saturating_mul(loops);
        if count == 0 || count > MAX_WAYPOINTS || goal.goal_index as usize >= goal.poses.len() {
            let message = format!(
                "{count} way-points from index {}, expected 1 to {MAX_WAYPOINTS} and an index among them",
                goal.goal_index
            );
            return Err(NavigationRefusal::Failed(failed(message)));
        }
        let task = |pose| {
            in_map(pose, context.frames, context.view)
                .map(Task::go)
                .map_err(|error| pose_error(error, failed))
        };
        let once = goal.poses.iter().map(task).collect::<Result<Vec<_>, _>>()?;
        Ok(once.iter().cycle().take(count).skip(goal.goal_index as usize).copied().collect())
    }

    fn feedback(goal: &Goal, view: &RunView, _progress: &GoalProgress, _frames: &RunFrames) -> Feedback {
        let place = goal.goal_index as usize + view.mission.ended.len();
        Feedback { current_waypoint: (place % goal.poses.len().max(1)) as u32 }
    }

    fn result(goal: &Goal, outcome: &NavigationOutcome, _time_s: f64) -> Outcome {
        let missed = |(task, reason): (usize, &trundle_runtime::Reason)| {
            let index = (goal.goal_index as usize + task) % goal.poses.len().max(1);
            WaypointStatus {
                waypoint_status: WaypointStatus::FAILED,
                waypoint_index: index as u32,
                waypoint_pose: goal.poses.get(index).cloned().unwrap_or_default(),
                error_code: of_reason(reason),
                error_msg: reason.to_string(),
            }
        };
        let error_code =
            outcome.code(Outcome::UNKNOWN, |_| Outcome::STOP_ON_MISSED_WAYPOINT, Outcome::UNKNOWN);
        Outcome {
            missed_waypoints: outcome.missed().map(missed).collect(),
            error_code,
            error_msg: outcome.message.clone(),
        }
    }
}
