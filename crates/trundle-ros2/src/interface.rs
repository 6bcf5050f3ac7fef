//! Types of topics, services and actions: what each interface is called.

use ros2_client::Message;

/// A message that topics carry.
pub trait MessageType: Message + Clone + Send + 'static {
    /// Package, as `geometry_msgs`.
    const PACKAGE: &'static str;
    /// Name, as `Pose`.
    const NAME: &'static str;
}

/// A service.
pub trait ServiceType {
    /// Package, as `std_srvs`.
    const PACKAGE: &'static str;
    /// Name, as `Empty`.
    const NAME: &'static str;
    /// The request.
    type Request: Message + Clone + Send + 'static;
    /// The response.
    type Response: Message + Clone + Default + Send + 'static;
}

/// An action.
pub trait ActionType {
    /// Package, as `nav2_msgs`.
    const PACKAGE: &'static str;
    /// Name, as `NavigateToPose`.
    const NAME: &'static str;
    /// The goal.
    type Goal: Message + Clone + Send + 'static;
    /// The result.
    type Result: Message + Clone + Send + 'static;
    /// The feedback.
    type Feedback: Message + Clone + Send + 'static;
}
