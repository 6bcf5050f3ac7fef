//! `FollowPath`: a drive along a path, from pose to pose of it, around obstacles near it.

use super::{left, passing};
use crate::generated::geometry_msgs::PoseStamped;
use crate::generated::nav2_msgs::{
    FollowPath, FollowPathFeedback as Feedback, FollowPathGoal as Goal, FollowPathResult as Outcome,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_reason;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::{GoalPoseError, in_map};
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::RunFrames;
use trundle_app::RunSetup;
use trundle_app::operator::RunView;
use trundle_core::Pose2;
use trundle_runtime::{Reason, Task};

/// Longest path \[m\]. Source: ours: a robot drives it in half an hour, and it makes 1,000 poses.
const MAX_PATH_M: f64 = 800.0;
/// Names of the controller: none, and Nav2's default.
const CONTROLLER_IDS: [&str; 2] = ["", "FollowPath"];
/// Distance along the path from one pose that the robot drives through to the next \[m\]. Source: ours, the braking distance from 0.7 m/s and
/// [`PASSED_M`].
const SPACING_M: f64 = 0.8;
/// Distance from such a pose at which the robot continues to the next \[m\]. Source: ours; with it the robot keeps within this distance of a
/// path that does not turn back within [`SPACING_M`], and slows down little.
const PASSED_M: f64 = 0.3;

impl NavigationAction for FollowPath {
    fn tasks(goal: &Goal, context: &GoalContext<'_>) -> Result<Vec<Task>, NavigationRefusal<Outcome>> {
        let failed = |error_code, error_msg| Outcome { error_code, error_msg, ..Outcome::default() };
        if !CONTROLLER_IDS.contains(&goal.controller_id.as_str()) {
            let message = format!("controller_id is '{}', expected none or FollowPath", goal.controller_id);
            return Err(NavigationRefusal::Failed(failed(Outcome::INVALID_CONTROLLER, message)));
        }
        if goal.path.poses.is_empty() {
            let message = "path.poses is empty, expected at least one".to_owned();
            return Err(NavigationRefusal::Failed(failed(Outcome::INVALID_PATH, message)));
        }
        let poses: Result<Vec<_>, _> = goal
            .path
            .poses
            .iter()
            .map(|pose| pose_in_map(goal, pose, context.frames, context.view))
            .collect();
        let poses = poses.map_err(|error| pose_error(error, |message| failed(Outcome::TF_ERROR, message)))?;
        let length: f64 = poses.windows(2).map(|pair| pair[0].distance(&pair[1])).sum();
        if length > MAX_PATH_M {
            let message = format!("the path is {length:.0} m long, expected at most {MAX_PATH_M:.0} m");
            return Err(NavigationRefusal::Failed(failed(Outcome::INVALID_PATH, message)));
        }
        Ok(passing(&resampled(&poses), PASSED_M))
    }

    fn feedback(_goal: &Goal, view: &RunView, _progress: &GoalProgress, _frames: &RunFrames) -> Feedback {
        let ahead: Vec<Pose2> = view.mission.left.iter().filter_map(RunSetup::goal_of).collect();
        let (to_next, _) = left(view, ahead.first().unwrap_or(&view.estimate.pose));
        let rest: f64 = ahead.windows(2).map(|pair| pair[0].distance(&pair[1])).sum();
        Feedback { distance_to_goal: to_next + rest as f32, speed: view.estimate.twist.v as f32 }
    }

    fn result(_goal: &Goal, outcome: &NavigationOutcome, _time_s: f64) -> Outcome {
        let error_code = outcome.code(Outcome::CONTROLLER_TIMED_OUT, code_of, Outcome::UNKNOWN);
        Outcome { error_code, error_msg: outcome.message.clone(), ..Outcome::default() }
    }
}

/// A pose of the path. A pose without a frame is in the frame of the path.
fn pose_in_map(
    goal: &Goal,
    pose: &PoseStamped,
    frames: &RunFrames,
    view: Option<&RunView>,
) -> Result<Pose2, GoalPoseError> {
    if !pose.header.frame_id.is_empty() {
        return in_map(pose, frames, view);
    }
    let mut pose = pose.clone();
    pose.header.frame_id.clone_from(&goal.path.header.frame_id);
    in_map(&pose, frames, view)
}

/// A pose at each [`SPACING_M`] along the path, and its end. Each but the last heads along the path: paths of other programs often hold
/// positions alone.
fn resampled(path: &[Pose2]) -> Vec<Pose2> {
    let (mut poses, mut travelled) = (Vec::new(), 0.0);
    for pair in path.windows(2) {
        let step = pair[1].position() - pair[0].position();
        let (length, heading) = (step.norm(), step.y.atan2(step.x));
        while (poses.len() + 1) as f64 * SPACING_M <= travelled + length {
            let part = ((poses.len() + 1) as f64 * SPACING_M - travelled) / length;
            let at = pair[0].position() + part * step;
            poses.push(Pose2::new(at.x, at.y, heading));
        }
        travelled += length;
    }
    // A pose right before the end would only slow the robot down.
    if travelled - poses.len() as f64 * SPACING_M < SPACING_M / 2.0 {
        poses.pop();
    }
    poses.extend(path.last());
    poses
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
    use crate::outputs::FrameNames;
    use trundle_core::Stamp;
    use trundle_runtime::NoPath;

    #[test]
    fn poses_along_a_path_have_one_distance_and_its_end() {
        let corner = |i: u32| match f64::from(i) * 0.05 {
            way if way <= 2.0 => Pose2::new(way, 0.0, 0.0),
            way => Pose2::new(2.0, way - 2.0, 0.0),
        };
        let dense: Vec<_> = (0..=84).map(corner).collect();
        let sparse = [corner(0), corner(40), corner(84)];
        for path in [dense.as_slice(), &sparse] {
            let poses = resampled(path);
            let (right, up) = (0.0, std::f64::consts::FRAC_PI_2);
            let expected =
                [(0.8, 0.0, right), (1.6, 0.0, right), (2.0, 0.4, up), (2.0, 1.2, up), (2.0, 2.2, 0.0)];
            assert_eq!(poses.len(), 5, "{poses:?}");
            for (pose, (x, y, theta)) in poses.iter().zip(expected) {
                assert!(pose.distance(&Pose2::new(x, y, theta)) < 1e-9 && pose.theta == theta, "{poses:?}");
            }
        }
        let laps: Vec<_> = [0.0, 1.0, 0.0, 1.0].map(|x| Pose2::new(x, 0.0, 0.0)).to_vec();
        assert_eq!(resampled(&laps).len(), 4, "a path that returns is driven to and fro");
        assert_eq!(resampled(&sparse[..1]), sparse[..1]);
        assert_eq!(resampled(&[sparse[0]; 3]), sparse[..1], "poses at one place");
    }

    #[test]
    fn the_last_goal_is_the_end_of_the_path_and_an_empty_path_fails() {
        let frames = RunFrames::of_own_odometry(FrameNames::default());
        let context = GoalContext { frames: &frames, view: None };
        let own = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, 2.0, 0.5)];
        let mut goal = Goal { path: path::to_ros(&own, Stamp::default(), "map"), ..Goal::default() };
        goal.path.poses[1].header.frame_id.clear();
        let tasks = FollowPath::tasks(&goal, &context).unwrap();
        assert!(
            matches!(tasks[..], [_, _, Task::Go(goal)] if goal.pose.distance(&own[1]) < 1e-12 && !goal.options.pass_through),
            "{tasks:?}"
        );
        let code = |goal: Goal| match FollowPath::tasks(&goal, &context) {
            Err(NavigationRefusal::Failed(result)) => result.error_code,
            other => panic!("{other:?}"),
        };
        assert_eq!(code(Goal::default()), Outcome::INVALID_PATH);
        for far in [900.0, 1e10, 1e300] {
            let ends = [Pose2::IDENTITY, Pose2::new(far, 0.0, 0.0), Pose2::new(-far, far, 0.0)];
            let path = path::to_ros(&ends, Stamp::default(), "map");
            assert_eq!(code(Goal { path, ..Goal::default() }), Outcome::INVALID_PATH, "{far} m");
        }
        assert_eq!(code(Goal { controller_id: "DWB".to_owned(), ..goal }), Outcome::INVALID_CONTROLLER);
        let cause = NoPath::GoalOutside;
        assert_eq!(code_of(&Reason::NoPath { cause, unseen: None }), Outcome::NO_VALID_CONTROL);
    }
}
