//! `NavigateToPose`.

use super::{current_pose, duration, left, refuse_behavior_tree};
use crate::generated::nav2_msgs::{
    NavigateToPose, NavigateToPoseFeedback as Feedback, NavigateToPoseGoal as Goal,
    NavigateToPoseResult as Outcome,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_reason;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_runtime::Task;

impl NavigationAction for NavigateToPose {
    fn tasks(goal: &Goal, context: &GoalContext<'_>) -> Result<Vec<Task>, NavigationRefusal<Outcome>> {
        refuse_behavior_tree(&goal.behavior_tree, |error_msg| Outcome {
            error_code: Outcome::FAILED_TO_LOAD_BEHAVIOR_TREE,
            error_msg,
        })?;
        let failed = |error_msg| Outcome { error_code: Outcome::TF_ERROR, error_msg };
        let pose =
            in_map(&goal.pose, context.frames, context.view).map_err(|error| pose_error(error, failed))?;
        Ok(vec![Task::go(pose)])
    }

    fn feedback(goal: &Goal, view: &RunView, progress: &GoalProgress, frames: &RunFrames) -> Feedback {
        let target = in_map(&goal.pose, frames, Some(view)).unwrap_or(view.estimate.pose);
        let (distance_remaining, estimated_time_remaining) = left(view, &target);
        Feedback {
            current_pose: current_pose(view, frames),
            navigation_time: duration(progress.time_s),
            estimated_time_remaining,
            number_of_recoveries: 0,
            distance_remaining,
        }
    }

    fn result(_goal: &Goal, outcome: &NavigationOutcome, _time_s: f64) -> Outcome {
        let error_code = outcome.code(Outcome::TIMEOUT, of_reason, Outcome::UNKNOWN);
        Outcome { error_code, error_msg: outcome.message.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::pose;
    use crate::outputs::FrameNames;
    use trundle_core::{Pose2, Stamp};

    #[test]
    fn wrong_frames_fail_and_broken_numbers_are_refused() {
        let frames = RunFrames::of_own_odometry(FrameNames::default());
        let context = GoalContext { frames: &frames, view: None };
        let goal = |x, frame: &str| Goal {
            pose: pose::stamped(&Pose2::new(x, 0.0, 1.0), Stamp::default(), frame),
            behavior_tree: String::new(),
        };
        let tasks = NavigateToPose::tasks(&goal(1.0, "map"), &context).unwrap();
        assert!(matches!(tasks[..], [Task::Go(goal)] if (goal.pose.theta - 1.0).abs() < 1e-12));
        let Err(NavigationRefusal::Failed(result)) = NavigateToPose::tasks(&goal(1.0, "moon"), &context)
        else {
            panic!()
        };
        assert_eq!(result.error_code, Outcome::TF_ERROR);
        assert!(result.error_msg.contains("'moon', expected map, odom or base_link"));
        let with_tree = Goal { behavior_tree: "tree.xml".to_owned(), ..goal(1.0, "map") };
        let Err(NavigationRefusal::Failed(result)) = NavigateToPose::tasks(&with_tree, &context) else {
            panic!()
        };
        assert_eq!(result.error_code, 9001);
        assert!(matches!(
            NavigateToPose::tasks(&goal(f64::NAN, "map"), &context),
            Err(NavigationRefusal::Refused(_))
        ));
    }
}
