//! Timing: speed profiles and trajectories.

pub(crate) mod config;
mod profile;
pub(crate) mod speeds;
pub(crate) mod trajectory;
mod turn;
