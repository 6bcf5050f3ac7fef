//! The pose monitor: whether the robot stands where the estimate says.
//!
//! A visual pose can be that of a look-alike place, and tracking can follow a person. Scans and wheels object to such poses. The
//! estimate is given up only with evidence that the robot was carried away.

pub(crate) mod displacement;
pub(crate) mod monitor;
pub(crate) mod recent_scans;
pub(crate) mod scan_continuity;
pub(crate) mod scan_likelihood;
#[cfg(test)]
pub(crate) mod testing;
pub(crate) mod visual_jump;
pub(crate) mod visual_motion;
