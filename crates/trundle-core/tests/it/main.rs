//! Laws of trundle-core's types, and the errors of their constructors.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod angles;
mod cameras;
mod drives;
mod files;
mod footprints;
mod grids;
mod images;
mod plane;
mod refusals;
mod scans;
mod space;
mod stamps;
mod trajectories;
