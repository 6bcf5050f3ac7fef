//! Moving obstacles: detection, tracks, forecast, and encounters with a trajectory.

mod cell_history;
mod cluster;
pub(crate) mod config;
pub(crate) mod forecast;
mod track;
pub(crate) mod tracker;
