//! The state machine from a goal and the world state to a twist.

pub(crate) mod drive_state;
pub(crate) mod machine;
pub(crate) mod navigator;
pub(crate) mod progress_checker;
pub(crate) mod relative_motion;
pub(crate) mod sight_recovery;
pub(crate) mod spin;
pub(crate) mod station_drive;
pub(crate) mod transitions;
