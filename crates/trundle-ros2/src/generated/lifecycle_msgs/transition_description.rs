//! `lifecycle_msgs/msg/TransitionDescription`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `TransitionDescription`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TransitionDescription {
    /// `Transition`.
    pub transition: crate::generated::lifecycle_msgs::Transition,
    /// `State`.
    pub start_state: crate::generated::lifecycle_msgs::State,
    /// `State`.
    pub goal_state: crate::generated::lifecycle_msgs::State,
}

impl ros2_client::Message for TransitionDescription {}

impl crate::interface::MessageType for TransitionDescription {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "TransitionDescription";
}
