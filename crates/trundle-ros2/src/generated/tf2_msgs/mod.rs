//! `tf2_msgs`. Written by `cargo xtask ros-interfaces`.

mod tf_message;

pub use tf_message::*;
