//! Closed loops: the controllers of trundle-control against a small model of the base.
#![expect(clippy::unwrap_used, reason = "these are tests")]

mod following;
mod path_tracking;
mod plant;
mod safety;
mod stabilization;
