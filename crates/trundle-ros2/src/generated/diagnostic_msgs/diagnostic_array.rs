//! `diagnostic_msgs/msg/DiagnosticArray`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `diagnostic_msgs`: `DiagnosticArray`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DiagnosticArray {
    /// `std_msgs/Header`.
    pub header: crate::generated::std_msgs::Header,
    /// `DiagnosticStatus[]`.
    pub status: Vec<crate::generated::diagnostic_msgs::DiagnosticStatus>,
}

impl ros2_client::Message for DiagnosticArray {}

impl crate::interface::MessageType for DiagnosticArray {
    const PACKAGE: &str = "diagnostic_msgs";
    const NAME: &str = "DiagnosticArray";
}
