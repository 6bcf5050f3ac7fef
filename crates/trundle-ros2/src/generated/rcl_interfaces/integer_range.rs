//! `rcl_interfaces/msg/IntegerRange`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `IntegerRange`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct IntegerRange {
    /// `int64`.
    pub from_value: i64,
    /// `int64`.
    pub to_value: i64,
    /// `uint64`.
    pub step: u64,
}

impl ros2_client::Message for IntegerRange {}

impl crate::interface::MessageType for IntegerRange {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "IntegerRange";
}
