//! `map_msgs`. Written by `cargo xtask ros-interfaces`.

mod occupancy_grid_update;

pub use occupancy_grid_update::*;
