//! `rcl_interfaces/msg/FloatingPointRange`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `rcl_interfaces`: `FloatingPointRange`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FloatingPointRange {
    /// `float64`.
    pub from_value: f64,
    /// `float64`.
    pub to_value: f64,
    /// `float64`.
    pub step: f64,
}

impl ros2_client::Message for FloatingPointRange {}

impl crate::interface::MessageType for FloatingPointRange {
    const PACKAGE: &str = "rcl_interfaces";
    const NAME: &str = "FloatingPointRange";
}
