//! A decision that runs beside the control loop, and what arrives while it runs.

use crate::world_state::{OwnedWorldState, WorldState};
use crate::{
    mission::MissionState,
    operator::RunSetting,
    workers::decision_worker::DecisionWorker,
    workers::fallback_controller::FallbackController,
    workers::job::{Job, Work},
};
use trundle_core::Twist2;

/// A decision that runs beside the control loop.
#[derive(Debug, Default)]
pub(super) struct Background {
    pub(super) is_used: bool,
    /// The job of the decision worker, until it is fetched.
    pub(super) decision: Option<Job>,
    /// Steers while the decision worker is away.
    pub(super) fallback: Option<FallbackController>,
    /// The mission that was given while the decision worker is away.
    pub(super) orders: Option<MissionState>,
    /// Settings that were changed while the decision worker is away.
    pub(super) changes: Vec<RunSetting>,
    /// Readings of bumper and cliff sensors while the decision worker is away.
    pub(super) felt: Vec<Felt>,
}

/// A reading of a sensor of contact or floor.
#[derive(Debug, Clone, Copy)]
pub(super) enum Felt {
    Touched(bool),
    OverEdge(bool),
}

impl Background {
    /// Whether jobs run beside the control loop.
    pub(super) fn is_used(&self) -> bool {
        self.is_used
    }

    /// Whether the next decision runs beside the control loop.
    pub(super) fn is_for(&self, decision_worker: &DecisionWorker, s: &WorldState<'_>) -> bool {
        self.is_used && decision_worker.may_take_long(s)
    }

    /// A control step while the decision worker is away. A given worker leaves with this step.
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

    /// Keeps a mission for the decision worker until it is back. From an empty mission on the robot brakes to rest.
    pub(super) fn set_mission(&mut self, mission: &MissionState) {
        if let (true, Some(fallback)) = (mission.left.tasks().is_empty(), &mut self.fallback) {
            fallback.halt();
        }
        self.orders = Some(mission.clone());
    }

    /// Whether wheel readings or a mission came that a running decision job does not include.
    pub(super) fn knows_more(&self) -> bool {
        !self.felt.is_empty() || self.orders.is_some()
    }
}
