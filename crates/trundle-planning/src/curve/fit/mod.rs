//! The curve through waypoints: a quadratic program.

pub(crate) mod config;
mod curvature_bound;
mod layout;
mod objective;
pub(crate) mod program;
mod rows;
pub(crate) mod segment;
