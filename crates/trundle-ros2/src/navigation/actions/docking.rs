//! `DockRobot` and `UndockRobot`, at the charging station whose light the base detects.

use super::duration;
use crate::generated::nav2_msgs::{
    DockRobot, DockRobotFeedback, DockRobotGoal, DockRobotResult, UndockRobot, UndockRobotFeedback,
    UndockRobotGoal, UndockRobotResult,
};
use crate::navigation::active_goal::GoalProgress;
use crate::navigation::error_codes::of_docking;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::FrameNames;
use std::time::Duration;
use trundle_app::operator::RunView;
use trundle_core::Pose2;
use trundle_runtime::Task;

/// Distance of the staging pose from a given dock, from which the search for its light begins \[m\]. Source: Nav2's default staging pose,
/// 0.7 m.
const STAGING_M: f64 = 0.7;

/// Names of the only dock known to the robot, and of its type: the charging station with infrared light.
const STATION_NAMES: [&str; 2] = ["", "station"];

/// A time limit; `None` for 0 s and below.
fn limit(seconds: f32) -> Option<Duration> {
    (seconds.is_finite() && seconds > 0.0).then(|| Duration::from_secs_f32(seconds))
}

impl NavigationAction for DockRobot {
    fn tasks(
        goal: &DockRobotGoal,
        context: &GoalContext<'_>,
    ) -> Result<Vec<Task>, NavigationRefusal<DockRobotResult>> {
        let failed = |error_msg| DockRobotResult {
            error_code: DockRobotResult::DOCK_NOT_VALID,
            error_msg,
            ..DockRobotResult::default()
        };
        if goal.use_dock_id && !STATION_NAMES.contains(&goal.dock_id.as_str()) {
            let error_msg = format!(
                "dock_id is '{}', expected none or station: the dock whose light the base sees",
                goal.dock_id
            );
            let error_code = DockRobotResult::DOCK_NOT_IN_DB;
            return Err(NavigationRefusal::Failed(DockRobotResult { error_code, ..failed(error_msg) }));
        }
        if goal.use_dock_id || !goal.navigate_to_staging_pose {
            return Ok(vec![Task::Dock]);
        }
        let dock = in_map(&goal.dock_pose, context.frames, context.view)
            .map_err(|error| pose_error(error, failed))?;
        Ok(vec![Task::go(dock * Pose2::new(-STAGING_M, 0.0, 0.0)), Task::Dock])
    }

    fn time_limit(goal: &DockRobotGoal) -> Option<Duration> {
        limit(goal.max_staging_time)
    }

    fn feedback(
        _goal: &DockRobotGoal,
        view: &RunView,
        progress: &GoalProgress,
        _frames: &FrameNames,
    ) -> DockRobotFeedback {
        let is_docking = matches!(view.mission.task, Some(Task::Dock));
        let state =
            if is_docking { DockRobotFeedback::CONTROLLING } else { DockRobotFeedback::NAV_TO_STAGING_POSE };
        DockRobotFeedback { state, docking_time: duration(progress.time_s), num_retries: 0 }
    }

    fn result(_goal: &DockRobotGoal, outcome: &NavigationOutcome, _time_s: f64) -> DockRobotResult {
        let error_code = outcome.code(DockRobotResult::TIMEOUT, of_docking, DockRobotResult::UNKNOWN);
        DockRobotResult {
            success: error_code == 0,
            error_code,
            num_retries: 0,
            error_msg: outcome.message.clone(),
        }
    }
}

impl NavigationAction for UndockRobot {
    /// A robot on its station backs off before any task: here before a turn by 0.
    fn tasks(
        goal: &UndockRobotGoal,
        _context: &GoalContext<'_>,
    ) -> Result<Vec<Task>, NavigationRefusal<UndockRobotResult>> {
        if !STATION_NAMES.contains(&goal.dock_type.as_str()) {
            let error_msg = format!("dock_type is '{}', expected none or station", goal.dock_type);
            let error_code = UndockRobotResult::DOCK_NOT_VALID;
            return Err(NavigationRefusal::Failed(UndockRobotResult {
                success: false,
                error_code,
                error_msg,
            }));
        }
        Ok(vec![Task::Turn { angle: 0.0 }])
    }

    fn time_limit(goal: &UndockRobotGoal) -> Option<Duration> {
        limit(goal.max_undocking_time)
    }

    fn feedback(
        _goal: &UndockRobotGoal,
        _view: &RunView,
        _progress: &GoalProgress,
        _frames: &FrameNames,
    ) -> UndockRobotFeedback {
        UndockRobotFeedback::default()
    }

    fn result(_goal: &UndockRobotGoal, outcome: &NavigationOutcome, _time_s: f64) -> UndockRobotResult {
        let failed = |_: &trundle_runtime::Reason| UndockRobotResult::FAILED_TO_CONTROL;
        let error_code = outcome.code(UndockRobotResult::TIMEOUT, failed, UndockRobotResult::UNKNOWN);
        UndockRobotResult { success: error_code == 0, error_code, error_msg: outcome.message.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn docks_of_other_names_fail_with_nav2s_codes() {
        let frames = FrameNames::default();
        let context = GoalContext { frames: &frames, view: None };
        let dock =
            |id: &str| DockRobotGoal { use_dock_id: true, dock_id: id.to_owned(), ..Default::default() };
        assert_eq!(DockRobot::tasks(&dock(""), &context), Ok(vec![Task::Dock]));
        let Err(NavigationRefusal::Failed(result)) = DockRobot::tasks(&dock("nowhere"), &context) else {
            panic!()
        };
        assert_eq!(result.error_code, DockRobotResult::DOCK_NOT_IN_DB);
        let undock = |kind: &str| UndockRobotGoal { dock_type: kind.to_owned(), ..Default::default() };
        assert!(UndockRobot::tasks(&undock("station"), &context).is_ok());
        let Err(NavigationRefusal::Failed(result)) = UndockRobot::tasks(&undock("nothing"), &context) else {
            panic!()
        };
        assert_eq!(result.error_code, UndockRobotResult::DOCK_NOT_VALID);
    }
}
