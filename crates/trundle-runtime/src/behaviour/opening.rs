//! The rest after power-on.

use crate::world_state::WorldState;
use trundle_core::Stamp;

/// The rest after power-on: it measures the gyro's bias and gives the first scan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Opening {
    started: Option<Stamp>,
    /// Duration of the rest, s.
    duration: f64,
}

impl Opening {
    pub(crate) fn new(duration: f64) -> Self {
        Self { started: None, duration }
    }

    /// Notes the first control step.
    pub(crate) fn start(&mut self, now: Stamp) {
        self.started.get_or_insert(now);
    }

    /// Whether the robot has been at rest since power-on for long enough to measure the gyro's bias.
    pub(crate) fn is_rested(&self, s: &WorldState<'_>) -> bool {
        self.started.is_some_and(|started| s.now - started >= self.duration)
    }

    /// Whether the robot may move by its scans: it has rested, and a scan exists.
    pub(crate) fn is_over(&self, s: &WorldState<'_>) -> bool {
        s.scan.is_some() && self.is_rested(s)
    }
}
