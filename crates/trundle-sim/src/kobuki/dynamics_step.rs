//! The step of the dynamics.

/// Length of a step of the dynamics, s. Source: ours.
pub(crate) const STEP_S: f64 = 1e-3;

/// Steps per second. Source: ours.
pub(crate) const STEPS_PER_SECOND: f64 = 1e3;
