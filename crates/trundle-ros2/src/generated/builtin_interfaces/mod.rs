//! `builtin_interfaces`. Written by `cargo xtask ros-interfaces`.

mod duration;
mod time;

pub use duration::*;
pub use time::*;
