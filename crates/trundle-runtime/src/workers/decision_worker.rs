//! The decision worker: mission executor and navigator.

use crate::world_state::WorldState;
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::goal::Goal,
    behaviour::navigator::{Decision, Navigator},
    config::RobotConfig,
    mission::MissionState,
    mission::executor::MissionExecutor,
    reason::TransitionReason,
    stage::{Stage, StageTimes},
    workers::fallback_controller::FallbackController,
};
use trundle_core::{Footprint, Invalid};

/// Decides the goals of the mission, the plans, and the twist towards the goal.
#[derive(Debug)]
pub(crate) struct DecisionWorker {
    pub(crate) navigator: Navigator,
    pub(crate) executor: MissionExecutor,
}

/// Additional clearance of paths to viewpoints in exploration \[m\]. Source: ours.
const EXPLORATION_CLEARANCE_M: f64 = 0.03;

impl DecisionWorker {
    pub(crate) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            navigator: Navigator::new(config, footprint)?,
            executor: MissionExecutor::new(
                &config.mission_executor,
                footprint.circumscribed_radius() + EXPLORATION_CLEARANCE_M,
            )?,
        })
    }

    pub(crate) fn begin(&mut self, mission: &MissionState) {
        self.executor.begin(mission);
        self.navigator.end_without_path(mission.by_operator);
        if mission.left.tasks().is_empty() {
            self.navigator.set_goal(Goal::Stay);
        }
    }

    /// One decision.
    pub(crate) fn step(&mut self, s: &WorldState<'_>, times: &mut StageTimes) -> Decision {
        let (executor, navigator) = (&mut self.executor, &mut self.navigator);
        if let Some(goal) = times.measure(Stage::Supervision, || executor.step(s, &navigator.state())) {
            navigator.set_goal_with(goal, executor.goal_options());
        }
        navigator.step(s, times)
    }

    /// Whether the next decision may take longer than a control step: a plan, a search for frontiers, a search for turns and straight
    /// moves. A wrong true costs little.
    pub(crate) fn may_take_long(&self, s: &WorldState<'_>) -> bool {
        self.executor.may_take_long(s, &self.navigator.state()) || self.navigator.may_take_long(s)
    }

    /// The controller that continues the last decision.
    pub(crate) fn fallback(&self) -> FallbackController {
        self.navigator.fallback()
    }

    /// State of the drive, and whether the mission is over; after its end, the state of the whole mission.
    pub(crate) fn state(&self) -> (DriveState, bool) {
        let finished = self.executor.is_idle() && !self.executor.records().is_empty();
        let state = match self.executor.failure() {
            Some(reason) if finished => DriveState::Stopped { reason },
            None if finished => DriveState::Arrived,
            _ => self.navigator.state(),
        };
        (state, finished)
    }

    /// Reason for the last change of the drive's state; `None` after the end of the mission.
    pub(crate) fn transition(&self) -> Option<TransitionReason> {
        let (_, is_finished) = self.state();
        self.navigator.transition().filter(|_| !is_finished)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mission::{Mission, Task, TaskEnd, TaskRecord};
    use crate::reason::{Reason, ReasonKind};
    use trundle_core::{Pose2, Stamp};

    fn worker() -> DecisionWorker {
        let config = RobotConfig::default();
        DecisionWorker::new(&config, &config.footprint().unwrap()).unwrap()
    }

    /// A finished mission with one task of this end.
    fn over(end: TaskEnd) -> MissionState {
        let (from, to) = (Stamp::default(), Stamp::default());
        let (task, pose) = (Task::Return, Pose2::IDENTITY);
        let ended =
            vec![TaskRecord { index: 0, task, end, from, to, pose, bound: None, before_restart: true }];
        MissionState { ended, ..MissionState::default() }
    }

    #[test]
    fn the_state_of_a_mission_that_is_over_is_that_of_all_its_tasks() {
        let mut worker = worker();
        assert_eq!(worker.state(), (DriveState::Idle, false), "no mission is not a mission that is over");
        worker.begin(&over(TaskEnd::Done));
        assert_eq!(worker.state(), (DriveState::Arrived, true));
        worker.begin(&over(TaskEnd::GivenUp { reason: Reason::PoseUnknown }));
        let (DriveState::Stopped { reason }, true) = worker.state() else { panic!("{:?}", worker.state()) };
        assert_eq!(reason.kinds(), [ReasonKind::TasksFailed, ReasonKind::PoseUnknown]);
    }

    #[test]
    fn a_task_that_is_left_keeps_the_mission_going_whatever_ended_before() {
        let mut worker = worker();
        let left = MissionState::new(Mission::new(vec![Task::Return]).unwrap());
        worker.begin(&MissionState { left: left.left, places: vec![1], ..over(TaskEnd::Done) });
        assert_eq!(worker.state(), (DriveState::Idle, false));
    }

    #[test]
    fn an_empty_mission_takes_the_goal_away_and_another_one_does_not() {
        let mut worker = worker();
        worker.navigator.set_goal(Goal::Exact(Pose2::new(1.0, 0.0, 0.0)));
        worker.begin(&MissionState::new(Mission::new(vec![Task::Return]).unwrap()));
        assert_eq!(
            worker.navigator.state(),
            DriveState::Initializing,
            "the robot may roll on to the next goal"
        );
        worker.begin(&MissionState::default());
        assert_eq!(worker.navigator.state(), DriveState::Idle);
    }
}
