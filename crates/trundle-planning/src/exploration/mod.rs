//! Frontier exploration.

pub(crate) mod config;
pub(crate) mod explorer;
pub(crate) mod frontier;
mod travel_distance;
