//! Closed loops: the controllers of trundle-control against a small model of the base.

mod following;
mod plant;
mod safety;
mod settling;
mod tracking;
