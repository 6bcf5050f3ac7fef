//! Steering by the decision worker, by the fallback controller during a decision job, or by an operator.

use super::background::{Background, ContactReading};
use super::event_log;
use crate::world_state::WorldState;
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::navigator::Decision,
    config::RobotConfig,
    mission::MissionState,
    operator::RunSetting,
    reason::TransitionReason,
    report::StepReport,
    stage::{Stage, StageTimes},
    workers::decision_worker::DecisionWorker,
    workers::job::Job,
    workers::teleop_controller::TeleopController,
};
use trundle_core::{Footprint, Invalid, Stamp, Twist2};

/// The controllers that compute twists from the world state.
#[derive(Debug)]
pub(super) struct Steering {
    /// `None` while a decision job runs.
    pub(super) decision_worker: Option<Box<DecisionWorker>>,
    pub(super) background: Background,
    /// Controller for an operator's twists.
    pub(super) teleop: TeleopController,
    /// The newest state of the mission.
    mission: MissionState,
    /// The newest drive state, and whether the mission is over.
    state: (DriveState, bool),
    /// Reason for the newest change of state.
    transition: Option<TransitionReason>,
}

impl Steering {
    /// Steering of a robot without a mission.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub(super) fn new(config: &RobotConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self {
            decision_worker: Some(Box::new(DecisionWorker::new(config, footprint)?)),
            background: Background::default(),
            teleop: TeleopController::new(config, footprint)?,
            mission: MissionState::default(),
            state: Default::default(),
            transition: None,
        })
    }

    /// Begins a mission, or resumes it at its recorded task.
    pub(super) fn begin(&mut self, mission: MissionState) {
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.begin(&mission),
            None => self.background.set_mission(&mission),
        }
        self.mission = mission;
    }

    /// Begins an operator's mission and ends driving by hand.
    pub(super) fn begin_for_operator(&mut self, mission: MissionState) {
        self.teleop.release();
        self.state.1 = false;
        self.begin(mission.of_operator());
    }

    /// A control step; commands a twist.
    pub(super) fn step(&mut self, world: &WorldState<'_>, times: &mut StageTimes, report: &mut StepReport) {
        match self.decision_worker.take() {
            Some(mut decision_worker) if !self.background.is_for(&decision_worker, world) => {
                let decision = decision_worker.step(world, times);
                self.decision_worker = Some(decision_worker);
                report.twist = Some(decision.twist);
                report.replanned = decision.replanned;
            }
            decision_worker => {
                let background = &mut self.background;
                report.twist = times.measure(Stage::Control, || background.steer(decision_worker, world));
            }
        }
    }

    /// Completes a report with the state after the step, which ended at `now`.
    pub(super) fn complete(&mut self, now: Stamp, report: &mut StepReport) {
        if let Some(decision_worker) = &self.decision_worker {
            let state = decision_worker.state();
            let transition = decision_worker.transition();
            event_log::state(now, &self.state.0, &state.0, transition);
            (self.state, self.transition) = (state, transition);
        }
        (report.state, report.finished) = self.state.clone();
        report.transition = self.transition;
    }

    /// The mission with the progress of the decision worker.
    pub(super) fn mission(&mut self) -> &MissionState {
        if let Some(decision_worker) = &self.decision_worker {
            self.mission = decision_worker.executor.mission();
        }
        &self.mission
    }

    /// The decision job, if one is due.
    pub(super) fn next_job(&mut self) -> Option<Job> {
        self.background.decision.take()
    }

    /// Takes the decision worker back with its decision. Commands its twist if no newer input arrived.
    pub(super) fn on_decided(
        &mut self,
        decision_worker: Box<DecisionWorker>,
        decision: &Decision,
        is_current: bool,
    ) -> Option<Twist2> {
        let twist = (is_current && !self.background.knows_more()).then_some(decision.twist);
        self.return_decision_worker(decision_worker, twist);
        twist
    }

    /// Passes the inputs that arrived during the job, and the last command, to the decision worker.
    fn return_decision_worker(&mut self, mut decision_worker: Box<DecisionWorker>, sent: Option<Twist2>) {
        let fallback = self.background.fallback.take();
        if let Some(sent) = sent.or(fallback.map(|fallback| fallback.sent)) {
            decision_worker.navigator.sent(sent);
        }
        for reading in self.background.contact_readings.drain(..) {
            match reading {
                ContactReading::Touched(pressed) => decision_worker.navigator.touch(pressed),
                ContactReading::OverEdge(over_edge) => decision_worker.navigator.cliff(over_edge),
            }
        }
        let navigator = &mut decision_worker.navigator;
        self.background.changes.drain(..).for_each(|setting| navigator.change(setting));
        if let Some(mission) = self.background.orders.take() {
            decision_worker.begin(&mission);
        }
        self.mission = decision_worker.executor.mission();
        self.decision_worker = Some(decision_worker);
    }

    /// Changes a setting during the run.
    pub(super) fn change(&mut self, setting: RunSetting) {
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.change(setting),
            None => self.background.changes.push(setting),
        }
    }

    /// Processes a bumper reading.
    pub(super) fn on_touch(&mut self, pressed: bool) {
        self.teleop.touched = pressed;
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.touch(pressed),
            None => self.background.contact_readings.push(ContactReading::Touched(pressed)),
        }
        if let Some(fallback) = &mut self.background.fallback {
            fallback.touched = pressed;
        }
    }

    /// Processes a reading of the cliff sensors.
    pub(super) fn on_cliff(&mut self, over_edge: bool) {
        self.teleop.over_edge = over_edge;
        match &mut self.decision_worker {
            Some(decision_worker) => decision_worker.navigator.cliff(over_edge),
            None => self.background.contact_readings.push(ContactReading::OverEdge(over_edge)),
        }
        if let Some(fallback) = &mut self.background.fallback {
            fallback.over_edge = over_edge;
        }
    }
}
