//! `unique_identifier_msgs`. Written by `cargo xtask ros-interfaces`.

mod uuid;

pub use uuid::*;
