//! `visualization_msgs`. Written by `cargo xtask ros-interfaces`.

mod marker;
mod marker_array;
mod mesh_file;
mod uv_coordinate;

pub use marker::*;
pub use marker_array::*;
pub use mesh_file::*;
pub use uv_coordinate::*;
