//! `std_msgs`. Written by `cargo xtask ros-interfaces`.

mod bool;
mod color_rgba;
mod empty;
mod float32;
mod header;
mod string;
mod u_int32;

pub use bool::*;
pub use color_rgba::*;
pub use empty::*;
pub use float32::*;
pub use header::*;
pub use string::*;
pub use u_int32::*;
