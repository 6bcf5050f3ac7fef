//! `DockRobot` and `UndockRobot`, at the charging station whose light the base detects.

use super::duration;
use crate::generated::nav2_msgs::{
    DockRobot, DockRobotFeedback, DockRobotGoal, DockRobotResult, UndockRobot, UndockRobotFeedback,
    UndockRobotGoal, UndockRobotResult,
};
use crate::navigation::active_goal::{GoalProgress, TimeLimit};
use crate::navigation::error_codes::of_docking;
use crate::navigation::goal_outcome::NavigationOutcome;
use crate::navigation::goal_pose::in_map;
use crate::navigation::navigation_action::{GoalContext, NavigationAction, NavigationRefusal, pose_error};
use crate::outputs::RunFrames;
use trundle_app::operator::RunView;
use trundle_core::Pose2;
use trundle_runtime::{Reason, Task, TaskEnd};

/// Distance of the staging pose from a given dock, from which the search for its light begins \[m\]. Source: Nav2's default staging pose,
/// 0.7 m.
const STAGING_M: f64 = 0.7;

/// Names of the only dock known to the robot, and of its type: the charging station with infrared light.
const STATION_NAMES: [&str; 2] = ["", "station"];

/// Whether a goal drives to the staging pose first, as a task of its own.
fn has_staging(goal: &DockRobotGoal) -> bool {
    goal.navigate_to_staging_pose && !goal.use_dock_id
}

/// The reason why the staging pose was not reached; `ended`: the tasks that have ended.
fn staging_failure<'e>(goal: &DockRobotGoal, ended: &'e [(usize, TaskEnd)]) -> Option<&'e Reason> {
    let staging = ended.first().filter(|(index, _)| *index == 0 && has_staging(goal));
    staging.and_then(|(_, end)| match end {
        TaskEnd::PutOff { reason } | TaskEnd::GivenUp { reason } => Some(reason),
        _ => None,
    })
}

/// A type that no dock of the robot has, as an error text.
fn foreign_type(dock_type: &str) -> Option<String> {
    let is_known = STATION_NAMES.contains(&dock_type);
    (!is_known).then(|| format!("dock_type is '{dock_type}', expected none or station"))
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
        if let Some(error_msg) = foreign_type(&goal.dock_type) {
            return Err(NavigationRefusal::Failed(failed(error_msg)));
        }
        if !has_staging(goal) {
            return Ok(vec![Task::Dock]);
        }
        let dock = in_map(&goal.dock_pose, context.frames, context.view)
            .map_err(|error| pose_error(error, failed))?;
        Ok(vec![Task::go(dock * Pose2::new(-STAGING_M, 0.0, 0.0)), Task::Dock])
    }

    /// The time is for the way to the staging pose alone, as in Nav2.
    fn time_limit(goal: &DockRobotGoal) -> Result<Option<TimeLimit>, String> {
        let limit = TimeLimit::of_seconds("max_staging_time", f64::from(goal.max_staging_time))?;
        Ok(limit.filter(|_| has_staging(goal)).map(|limit| TimeLimit { is_of_first_task: true, ..limit }))
    }

    /// A robot that does not reach the staging pose does not dock.
    fn failure(goal: &DockRobotGoal, ended: &[(usize, TaskEnd)]) -> Option<Reason> {
        staging_failure(goal, ended).cloned()
    }

    fn feedback(
        _goal: &DockRobotGoal,
        view: &RunView,
        progress: &GoalProgress,
        _frames: &RunFrames,
    ) -> DockRobotFeedback {
        let is_docking = matches!(view.mission.task, Some(Task::Dock));
        let state =
            if is_docking { DockRobotFeedback::CONTROLLING } else { DockRobotFeedback::NAV_TO_STAGING_POSE };
        DockRobotFeedback { state, docking_time: duration(progress.time_s), num_retries: 0 }
    }

    fn result(goal: &DockRobotGoal, outcome: &NavigationOutcome, _time_s: f64) -> DockRobotResult {
        let error_code = if staging_failure(goal, &outcome.ended).is_some() {
            DockRobotResult::FAILED_TO_STAGE
        } else {
            outcome.code(DockRobotResult::FAILED_TO_STAGE, of_docking, DockRobotResult::UNKNOWN)
        };
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
        if let Some(error_msg) = foreign_type(&goal.dock_type) {
            let error_code = UndockRobotResult::DOCK_NOT_VALID;
            return Err(NavigationRefusal::Failed(UndockRobotResult {
                success: false,
                error_code,
                error_msg,
            }));
        }
        Ok(vec![Task::Turn { angle: 0.0 }])
    }

    fn time_limit(goal: &UndockRobotGoal) -> Result<Option<TimeLimit>, String> {
        TimeLimit::of_seconds("max_undocking_time", f64::from(goal.max_undocking_time))
    }

    fn feedback(
        _goal: &UndockRobotGoal,
        _view: &RunView,
        _progress: &GoalProgress,
        _frames: &RunFrames,
    ) -> UndockRobotFeedback {
        UndockRobotFeedback::default()
    }

    fn result(_goal: &UndockRobotGoal, outcome: &NavigationOutcome, _time_s: f64) -> UndockRobotResult {
        let failed = |_: &Reason| UndockRobotResult::FAILED_TO_CONTROL;
        let error_code = outcome.code(UndockRobotResult::TIMEOUT, failed, UndockRobotResult::UNKNOWN);
        UndockRobotResult { success: error_code == 0, error_code, error_msg: outcome.message.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outputs::FrameNames;

    #[test]
    fn docks_of_other_names_fail_with_nav2s_codes() {
        let frames = RunFrames::of_own_odometry(FrameNames::default());
        let context = GoalContext { frames: &frames, view: None };
        let dock =
            |id: &str| DockRobotGoal { use_dock_id: true, dock_id: id.to_owned(), ..Default::default() };
        assert_eq!(DockRobot::tasks(&dock(""), &context), Ok(vec![Task::Dock]));
        let Err(NavigationRefusal::Failed(result)) = DockRobot::tasks(&dock("nowhere"), &context) else {
            panic!()
        };
        assert_eq!(result.error_code, DockRobotResult::DOCK_NOT_IN_DB);
        let typed = |kind: &str| DockRobotGoal { dock_type: kind.to_owned(), ..dock("station") };
        assert_eq!(DockRobot::tasks(&typed("station"), &context), Ok(vec![Task::Dock]));
        let Err(NavigationRefusal::Failed(result)) = DockRobot::tasks(&typed("nova_carter"), &context) else {
            panic!()
        };
        assert_eq!(result.error_code, DockRobotResult::DOCK_NOT_VALID);
        assert!(result.error_msg.contains("nova_carter"), "{}", result.error_msg);
        let undock = |kind: &str| UndockRobotGoal { dock_type: kind.to_owned(), ..Default::default() };
        assert!(UndockRobot::tasks(&undock("station"), &context).is_ok());
        let Err(NavigationRefusal::Failed(result)) = UndockRobot::tasks(&undock("nothing"), &context) else {
            panic!()
        };
        assert_eq!(result.error_code, UndockRobotResult::DOCK_NOT_VALID);
    }

    fn staged(max_staging_time: f32) -> DockRobotGoal {
        let dock_pose = crate::convert::pose::stamped(&Pose2::IDENTITY, Default::default(), "map");
        DockRobotGoal { dock_pose, max_staging_time, navigate_to_staging_pose: true, ..Default::default() }
    }

    #[test]
    fn times_that_are_none_refuse_the_goal_and_only_staging_is_limited() {
        for broken in [f32::MAX, 1e30, f32::INFINITY, f32::NAN] {
            let why = DockRobot::time_limit(&staged(broken)).unwrap_err();
            assert!(why.starts_with("max_staging_time is ") && why.contains("expected at most"), "{why}");
            let goal = UndockRobotGoal { max_undocking_time: broken, ..Default::default() };
            assert!(UndockRobot::time_limit(&goal).unwrap_err().starts_with("max_undocking_time is "));
        }
        assert_eq!(DockRobot::time_limit(&staged(0.0)), Ok(None));
        let limit = DockRobot::time_limit(&staged(20.0)).unwrap().unwrap();
        assert!(limit.is_of_first_task && limit.time.as_secs() == 20);
        let direct = DockRobotGoal { navigate_to_staging_pose: false, ..staged(20.0) };
        assert_eq!(
            DockRobot::time_limit(&direct),
            Ok(None),
            "without a way to the staging pose nothing is limited"
        );
    }

    #[test]
    fn a_staging_pose_that_is_not_reached_ends_the_goal_with_nav2s_code() {
        let (goal, reason) = (staged(0.0), || Reason::MovingObstacle);
        let put_off = (0, TaskEnd::PutOff { reason: reason() });
        assert_eq!(DockRobot::failure(&goal, &[]), None);
        assert_eq!(DockRobot::failure(&goal, &[(0, TaskEnd::Done)]), None);
        assert_eq!(DockRobot::failure(&goal, std::slice::from_ref(&put_off)), Some(reason()));
        let code = |ended, reason: Option<Reason>| {
            let outcome = reason.map_or_else(NavigationOutcome::timed_out, NavigationOutcome::of_reason);
            DockRobot::result(&goal, &NavigationOutcome { ended, ..outcome }, 1.0).error_code
        };
        assert_eq!(code(vec![put_off], Some(reason())), DockRobotResult::FAILED_TO_STAGE);
        assert_eq!(code(vec![], None), DockRobotResult::FAILED_TO_STAGE, "only staging has a time");
        let docked = vec![(0, TaskEnd::Done), (1, TaskEnd::GivenUp { reason: reason() })];
        assert_eq!(code(docked, Some(reason())), DockRobotResult::UNKNOWN);
    }
}
