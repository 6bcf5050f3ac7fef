//! The actions of the robot in each state, one file per state.

pub(crate) mod approach;
pub(crate) mod arrival;
pub(crate) mod detour;
pub(crate) mod drive;
pub(crate) mod initialize;
pub(crate) mod maneuver;
pub(crate) mod plan;
pub(crate) mod recover;
pub(crate) mod relative;
pub(crate) mod relocalize;
pub(crate) mod replan;
pub(crate) mod spin_once;
pub(crate) mod station;
pub(crate) mod wait;
