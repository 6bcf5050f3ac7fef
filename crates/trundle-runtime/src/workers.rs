//! The robot's long work as jobs that run beside the control loop, and what steers while a decision is under way.

pub(crate) mod decision_worker;
pub(crate) mod fallback_controller;
pub(crate) mod job;
pub(crate) mod perception_worker;
