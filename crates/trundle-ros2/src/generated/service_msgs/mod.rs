//! `service_msgs`. Written by `cargo xtask ros-interfaces`.

mod service_event_info;

pub use service_event_info::*;
