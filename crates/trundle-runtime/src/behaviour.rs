//! The state machine from a goal and the world state to a twist.

pub(crate) mod contacts;
pub(crate) mod drive_state;
pub(crate) mod goal;
pub(crate) mod machine;
pub(crate) mod navigator;
pub(crate) mod opening;
pub(crate) mod path_planner;
pub(crate) mod path_search;
pub(crate) mod progress_checker;
pub(crate) mod relative_motion;
pub(crate) mod sight_recovery;
pub(crate) mod spin;
pub(crate) mod state;
pub(crate) mod states;
pub(crate) mod station_drive;
pub(crate) mod tools;
pub(crate) mod transitions;
pub(crate) mod view_monitor;
