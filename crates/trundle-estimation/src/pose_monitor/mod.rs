//! The pose monitor: checks the estimate of the robot's pose.
//!
//! A visual pose can belong to a look-alike place, and tracking can follow a person. Scans and wheels contradict such poses. The estimate
//! is abandoned only on evidence that the robot was carried away.

pub(crate) mod displacement;
pub(crate) mod monitor;
pub(crate) mod recent_scans;
pub(crate) mod scan_continuity;
pub(crate) mod scan_likelihood;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod visual_jump;
pub(crate) mod visual_motion;
