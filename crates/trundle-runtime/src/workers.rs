//! Long work of the robot as jobs beside the control loop, and the controllers while a decision job runs or a person drives.

pub(crate) mod decision_worker;
pub(crate) mod fallback_controller;
pub(crate) mod job;
pub(crate) mod perception_worker;
pub(crate) mod teleop_controller;
