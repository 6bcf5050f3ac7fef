//! Long work of the robot as jobs beside the control loop, and the controller while a decision job runs.

pub(crate) mod decision_worker;
pub(crate) mod fallback_controller;
pub(crate) mod job;
pub(crate) mod perception_worker;
