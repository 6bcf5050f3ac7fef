//! `lifecycle_msgs/msg/TransitionEvent`. Written by `cargo xtask ros-interfaces`.

use serde::{Deserialize, Serialize};

/// `lifecycle_msgs`: `TransitionEvent`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TransitionEvent {
    /// `uint64`.
    pub timestamp: u64,
    /// `Transition`.
    pub transition: crate::generated::lifecycle_msgs::Transition,
    /// `State`.
    pub start_state: crate::generated::lifecycle_msgs::State,
    /// `State`.
    pub goal_state: crate::generated::lifecycle_msgs::State,
}

impl ros2_client::Message for TransitionEvent {}

impl crate::interface::MessageType for TransitionEvent {
    const PACKAGE: &str = "lifecycle_msgs";
    const NAME: &str = "TransitionEvent";
}
