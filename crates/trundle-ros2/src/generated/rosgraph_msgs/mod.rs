//! `rosgraph_msgs`. Written by `cargo xtask ros-interfaces`.

mod clock;

pub use clock::*;
