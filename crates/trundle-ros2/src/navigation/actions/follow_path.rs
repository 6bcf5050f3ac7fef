//! `FollowPath`: a drive to the end of a path, on the robot's own plan.

use super::left;
use crate::generated::nav2_msgs::{
    FollowPath, FollowPathFeedback as Feedback, FollowPathGoal as Goal, FollowPathResult as Outcome,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_reason;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::FrameNames;
use trundle_app::operator::RunView;
use trundle_core::Pose2;
use trundle_runtime::{Reason, Task};

/// Names of the controller: none, and Nav2's default.
const CONTROLLER_IDS: [&str; 2] = ["", "FollowPath"];

impl NavigationAction for FollowPath {
    fn tasks(goal: &Goal, context: &GoalContext<'_>) -> Result<Vec<Task>, NavigationRefusal<Outcome>> {
        let failed = |error_code, error_msg| Outcome { error_code, error_msg, ..Outcome::default() };
        if !CONTROLLER_IDS.contains(&goal.controller_id.as_str()) {
            let message = format!("controller_id is '{}', expected none or FollowPath", goal.controller_id);
            return Err(NavigationRefusal::Failed(failed(Outcome::INVALID_CONTROLLER, message)));
        }
        let end = end_in_map(goal, context.frames, context.view).ok_or_else(|| {
            let message = "path.poses is empty, expected at least one".to_owned();
            NavigationRefusal::Failed(failed(Outcome::INVALID_PATH, message))
        })?;
        let pose = end.map_err(|error| pose_error(error, |message| failed(Outcome::TF_ERROR, message)))?;
        Ok(vec![Task::go(pose)])
    }

    fn feedback(goal: &Goal, view: &RunView, _progress: &GoalProgress, frames: &FrameNames) -> Feedback {
        let end = end_in_map(goal, frames, Some(view)).and_then(Result::ok);
        let (distance_to_goal, _) = left(view, &end.unwrap_or(view.estimate.pose));
        Feedback { distance_to_goal, speed: view.estimate.twist.v as f32 }
    }

    fn result(_goal: &Goal, outcome: &NavigationOutcome, _time_s: f64) -> Outcome {
        let error_code = outcome.code(Outcome::CONTROLLER_TIMED_OUT, code_of, Outcome::UNKNOWN);
        Outcome { error_code, error_msg: outcome.message.clone(), ..Outcome::default() }
    }
}

/// The last pose of the path; `None` for an empty path. A pose without a frame is in the frame of the path.
fn end_in_map(
    goal: &Goal,
    frames: &FrameNames,
    view: Option<&RunView>,
) -> Option<Result<Pose2, crate::navigation::goal_pose::GoalPoseError>> {
    let mut end = goal.path.poses.last()?.clone();
    if end.header.frame_id.is_empty() {
        end.header.frame_id.clone_from(&goal.path.header.frame_id);
    }
    Some(in_map(&end, frames, view))
}

/// The controller's code for a reason: if the planner has a code, no control leads along the path.
fn code_of(reason: &Reason) -> u16 {
    match of_reason(reason) {
        code @ Outcome::UNKNOWN..=Outcome::CONTROLLER_TIMED_OUT => code,
        200..=299 => Outcome::NO_VALID_CONTROL,
        _ => Outcome::UNKNOWN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::path;
    use trundle_core::Stamp;
    use trundle_runtime::NoPath;

    #[test]
    fn the_goal_is_the_end_of_the_path_and_an_empty_path_fails() {
        let frames = FrameNames::default();
        let context = GoalContext { frames: &frames, view: None };
        let own = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, 2.0, 0.5)];
        let mut goal = Goal { path: path::to_ros(&own, Stamp::default(), "map"), ..Goal::default() };
        goal.path.poses[1].header.frame_id.clear();
        let tasks = FollowPath::tasks(&goal, &context).unwrap();
        assert!(matches!(tasks[..], [Task::Go(goal)] if goal.pose.distance(&own[1]) < 1e-12), "{tasks:?}");
        let code = |goal: Goal| match FollowPath::tasks(&goal, &context) {
            Err(NavigationRefusal::Failed(result)) => result.error_code,
            other => panic!("{other:?}"),
        };
        assert_eq!(code(Goal::default()), Outcome::INVALID_PATH);
        assert_eq!(code(Goal { controller_id: "DWB".to_owned(), ..goal }), Outcome::INVALID_CONTROLLER);
        let cause = NoPath::GoalOutside;
        assert_eq!(code_of(&Reason::NoPath { cause, unseen: None }), Outcome::NO_VALID_CONTROL);
    }
}
