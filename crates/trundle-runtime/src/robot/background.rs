//! A decision in parallel with the control loop, and the inputs that arrive during it.

use crate::world_state::{OwnedWorldState, WorldState};
use crate::{
    mission::MissionState,
    operator::RunSetting,
    workers::decision_worker::DecisionWorker,
    workers::fallback_controller::FallbackController,
    workers::job::{Job, Work},
};
use trundle_core::Twist2;

/// State of decisions in parallel with the control loop.
#[derive(Debug, Default)]
pub(super) struct Background {
    pub(super) is_used: bool,
    /// The job of the decision worker, before it is fetched.
    pub(super) decision: Option<Job>,
    /// The controller during a decision job.
    pub(super) fallback: Option<FallbackController>,
    /// The mission given during a decision job.
    pub(super) orders: Option<MissionState>,
    /// Settings changed during a decision job.
    pub(super) changes: Vec<RunSetting>,
    /// Readings of bumper and cliff sensors during a decision job.
    pub(super) contact_readings: Vec<ContactReading>,
}

/// A reading of a bumper or cliff sensor.
#[derive(Debug, Clone, Copy)]
pub(super) enum ContactReading {
    Touched(bool),
    OverEdge(bool),
}

impl Background {
    /// Whether jobs run in parallel with the control loop.
    pub(super) fn is_used(&self) -> bool {
        self.is_used
    }

    /// Whether the next decision runs in parallel with the control loop.
    pub(super) fn is_for(&self, decision_worker: &DecisionWorker, s: &WorldState<'_>) -> bool {
        self.is_used && decision_worker.may_take_long(s)
    }

    /// A control step during a decision job. A given worker starts a job with this step.
    pub(super) fn steer(
        &mut self,
        decision_worker: Option<Box<DecisionWorker>>,
        s: &WorldState<'_>,
    ) -> Option<Twist2> {
        if let Some(decision_worker) = decision_worker {
            self.fallback = Some(decision_worker.fallback());
            self.decision =
                Some(Job(Work::Decide { decision_worker, around: Box::new(OwnedWorldState::from(s)) }));
        }
        self.fallback.as_mut().map(|fallback| fallback.step(s))
    }

    /// Keeps a mission until the end of the decision job. With an empty mission the robot brakes to rest.
    pub(super) fn set_mission(&mut self, mission: &MissionState) {
        if let (true, Some(fallback)) = (mission.left.tasks().is_empty(), &mut self.fallback) {
            fallback.halt();
        }
        self.orders = Some(mission.clone());
    }

    /// Whether readings or a mission arrived that a running decision job does not include.
    pub(super) fn knows_more(&self) -> bool {
        !self.contact_readings.is_empty() || self.orders.is_some()
    }
}
