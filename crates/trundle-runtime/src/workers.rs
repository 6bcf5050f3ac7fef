//! Long work of the robot as jobs, and the controllers used during a decision job or teleoperation.

pub(crate) mod decision_worker;
pub(crate) mod fallback_controller;
pub(crate) mod job;
pub(crate) mod perception_worker;
pub(crate) mod teleop_controller;
