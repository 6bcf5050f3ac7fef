//! Topics that no user chooses: introspection of services, and the inner topics of actions.

use super::messages::types;

/// Kinds of interfaces whose messages are not those of topics. Source: `ros2 interface list`.
const INNER_KINDS: [&str; 2] = ["/srv/", "/action/"];

/// Whether a topic is hidden: its messages are parts of services or actions, or a part of its name begins with an underscore \[ROS 2, topic
/// names\]. A topic of a sensor is never hidden.
pub(in crate::ros) fn is_hidden(topic: &str, kind: &str) -> bool {
    let has_inner_kind = INNER_KINDS.iter().any(|inner| kind.contains(inner));
    let has_hidden_name = topic.split('/').any(|part| part.starts_with('_'));
    has_inner_kind || has_hidden_name && !types::is_sensor(kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn services_and_actions_are_hidden_and_sensors_are_not() {
        for (topic, kind) in [
            ("/set_bool/_service_event", "std_srvs/srv/SetBool_Event"),
            ("/events", "rcl_interfaces/srv/GetParameters_Event"),
            ("/navigate_to_pose/_action/status", "action_msgs/msg/GoalStatusArray"),
            ("/go/_action/feedback", "nav2_msgs/action/NavigateToPose_FeedbackMessage"),
        ] {
            assert!(is_hidden(topic, kind), "{topic} {kind}");
        }
        for (topic, kind) in [
            ("/_internal/scan", "sensor_msgs/msg/LaserScan"),
            ("/chatter", "std_msgs/msg/String"),
            ("/parameter_events", "rcl_interfaces/msg/ParameterEvent"),
        ] {
            assert!(!is_hidden(topic, kind), "{topic} {kind}");
        }
    }
}
