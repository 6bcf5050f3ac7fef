//! Occupancy grid from scans at known poses.

mod from_grid;
mod mapper;

pub use mapper::{GridMapper, Insertion};
