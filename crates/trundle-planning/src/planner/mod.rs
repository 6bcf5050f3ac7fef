//! The planner.

pub(crate) mod api;
mod core;
