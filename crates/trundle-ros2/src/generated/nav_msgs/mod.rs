//! `nav_msgs`. Written by `cargo xtask ros-interfaces`.

mod get_map;
mod goals;
mod map_meta_data;
mod occupancy_grid;
mod odometry;
mod path;

pub use get_map::*;
pub use goals::*;
pub use map_meta_data::*;
pub use occupancy_grid::*;
pub use odometry::*;
pub use path::*;
