//! `Spin`, `BackUp` and `DriveOnHeading`: motions relative to the robot's pose.

use super::duration;
use crate::convert::stamp;
use crate::generated::builtin_interfaces::Duration as Allowance;
use crate::generated::geometry_msgs::Point;
use crate::generated::nav2_msgs::{
    BackUp, BackUpFeedback, BackUpGoal, BackUpResult, DriveOnHeading, DriveOnHeadingFeedback,
    DriveOnHeadingGoal, DriveOnHeadingResult, Spin, SpinFeedback, SpinGoal, SpinResult,
};
use crate::navigation::active_goal::{GoalProgress, TimeLimit};
use crate::navigation::error_codes::MotionCodes;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal};
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_core::wrap_angle;
use trundle_runtime::{Reason, Task};

/// Codes of `Spin`.
const SPIN_CODES: MotionCodes = MotionCodes {
    collision_ahead: SpinResult::COLLISION_AHEAD,
    tf_error: SpinResult::TF_ERROR,
    unknown: SpinResult::UNKNOWN,
};
/// Codes of `BackUp`.
const BACK_UP_CODES: MotionCodes = MotionCodes {
    collision_ahead: BackUpResult::COLLISION_AHEAD,
    tf_error: BackUpResult::TF_ERROR,
    unknown: BackUpResult::UNKNOWN,
};
/// Codes of `DriveOnHeading`.
const HEADING_CODES: MotionCodes = MotionCodes {
    collision_ahead: DriveOnHeadingResult::COLLISION_AHEAD,
    tf_error: DriveOnHeadingResult::TF_ERROR,
    unknown: DriveOnHeadingResult::UNKNOWN,
};

/// The time that a goal allows; `None` for 0, as in Nav2.
fn allowance(time: &Allowance) -> Result<Option<TimeLimit>, String> {
    TimeLimit::of_seconds("time_allowance", stamp::seconds(time))
}

/// A straight drive, or why its numbers are wrong.
fn straight(target: &Point, speed: f32, ahead: f64) -> Result<Vec<Task>, String> {
    if target.y != 0.0 || target.z != 0.0 {
        return Err(format!("target is ({}, {}, {}) m, expected y and z 0", target.x, target.y, target.z));
    }
    let (distance, speed) = (target.x, f64::from(speed));
    if !(distance.is_finite() && speed.is_finite()) || speed == 0.0 {
        return Err(format!(
            "target.x is {distance} m and speed {speed} m/s, expected finite numbers, the speed not 0"
        ));
    }
    Ok(vec![Task::Straight { distance: ahead * distance.abs(), speed: speed.abs() }])
}

impl NavigationAction for Spin {
    fn tasks(
        goal: &SpinGoal,
        _context: &GoalContext<'_>,
    ) -> Result<Vec<Task>, NavigationRefusal<SpinResult>> {
        if !goal.target_yaw.is_finite() {
            return Err(NavigationRefusal::Refused(format!(
                "target_yaw is {} rad, expected a finite number",
                goal.target_yaw
            )));
        }
        Ok(vec![Task::Turn { angle: f64::from(goal.target_yaw) }])
    }

    fn time_limit(goal: &SpinGoal) -> Result<Option<TimeLimit>, String> {
        allowance(&goal.time_allowance)
    }

    fn feedback(
        _goal: &SpinGoal,
        view: &RunView,
        progress: &GoalProgress,
        _frames: &RunFrames,
    ) -> SpinFeedback {
        SpinFeedback {
            angular_distance_traveled: wrap_angle(view.estimate.pose.theta - progress.start.theta) as f32,
        }
    }

    fn result(_goal: &SpinGoal, outcome: &NavigationOutcome, time_s: f64) -> SpinResult {
        let code = |reason: &Reason| SPIN_CODES.of_reason(reason);
        let error_code = outcome.code(SpinResult::TIMEOUT, code, SpinResult::UNKNOWN);
        SpinResult { total_elapsed_time: duration(time_s), error_code, error_msg: outcome.message.clone() }
    }
}

impl NavigationAction for BackUp {
    fn tasks(
        goal: &BackUpGoal,
        _context: &GoalContext<'_>,
    ) -> Result<Vec<Task>, NavigationRefusal<BackUpResult>> {
        let failed = |error_msg| BackUpResult {
            error_code: BackUpResult::INVALID_INPUT,
            error_msg,
            ..BackUpResult::default()
        };
        straight(&goal.target, goal.speed, -1.0).map_err(|message| NavigationRefusal::Failed(failed(message)))
    }

    fn time_limit(goal: &BackUpGoal) -> Result<Option<TimeLimit>, String> {
        allowance(&goal.time_allowance)
    }

    fn feedback(
        _goal: &BackUpGoal,
        view: &RunView,
        progress: &GoalProgress,
        _frames: &RunFrames,
    ) -> BackUpFeedback {
        BackUpFeedback { distance_traveled: view.estimate.pose.distance(&progress.start) as f32 }
    }

    fn result(_goal: &BackUpGoal, outcome: &NavigationOutcome, time_s: f64) -> BackUpResult {
        let code = |reason: &Reason| BACK_UP_CODES.of_reason(reason);
        let error_code = outcome.code(BackUpResult::TIMEOUT, code, BackUpResult::UNKNOWN);
        BackUpResult { total_elapsed_time: duration(time_s), error_code, error_msg: outcome.message.clone() }
    }
}

impl NavigationAction for DriveOnHeading {
    fn tasks(
        goal: &DriveOnHeadingGoal,
        _context: &GoalContext<'_>,
    ) -> Result<Vec<Task>, NavigationRefusal<DriveOnHeadingResult>> {
        let failed = |error_msg| DriveOnHeadingResult {
            error_code: DriveOnHeadingResult::INVALID_INPUT,
            error_msg,
            ..DriveOnHeadingResult::default()
        };
        if goal.target.x * f64::from(goal.speed) < 0.0 {
            let message =
                format!("target.x is {} m and speed {} m/s, expected equal signs", goal.target.x, goal.speed);
            return Err(NavigationRefusal::Failed(failed(message)));
        }
        let ahead = if goal.target.x < 0.0 { -1.0 } else { 1.0 };
        straight(&goal.target, goal.speed, ahead)
            .map_err(|message| NavigationRefusal::Failed(failed(message)))
    }

    fn time_limit(goal: &DriveOnHeadingGoal) -> Result<Option<TimeLimit>, String> {
        allowance(&goal.time_allowance)
    }

    fn feedback(
        _goal: &DriveOnHeadingGoal,
        view: &RunView,
        progress: &GoalProgress,
        _frames: &RunFrames,
    ) -> DriveOnHeadingFeedback {
        DriveOnHeadingFeedback { distance_traveled: view.estimate.pose.distance(&progress.start) as f32 }
    }

    fn result(_goal: &DriveOnHeadingGoal, outcome: &NavigationOutcome, time_s: f64) -> DriveOnHeadingResult {
        let code = |reason: &Reason| HEADING_CODES.of_reason(reason);
        let error_code = outcome.code(DriveOnHeadingResult::TIMEOUT, code, DriveOnHeadingResult::UNKNOWN);
        DriveOnHeadingResult {
            total_elapsed_time: duration(time_s),
            error_code,
            error_msg: outcome.message.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outputs::FrameNames;

    #[test]
    fn backing_up_goes_back_and_broken_targets_fail_with_nav2s_code() {
        let frames = RunFrames::of_own_odometry(FrameNames::default());
        let context = GoalContext { frames: &frames, view: None };
        let goal =
            |x, y, speed| BackUpGoal { target: Point { x, y, z: 0.0 }, speed, ..BackUpGoal::default() };
        let tasks = BackUp::tasks(&goal(0.25, 0.0, 0.5), &context).unwrap();
        assert_eq!(tasks, [Task::Straight { distance: -0.25, speed: 0.5 }]);
        for broken in [goal(0.25, 0.1, 0.5), goal(f64::NAN, 0.0, 0.5), goal(0.25, 0.0, 0.0)] {
            let Err(NavigationRefusal::Failed(result)) = BackUp::tasks(&broken, &context) else {
                panic!("{broken:?}")
            };
            assert_eq!(result.error_code, BackUpResult::INVALID_INPUT);
        }
        let spin = SpinGoal { target_yaw: f32::NAN, ..SpinGoal::default() };
        assert!(matches!(Spin::tasks(&spin, &context), Err(NavigationRefusal::Refused(_))));
    }
}
