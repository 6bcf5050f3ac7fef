//! A topic of twists in either form: `TwistStamped` or `Twist`.

use crate::Ros2Error;
use crate::convert::twist;
use crate::generated::geometry_msgs::{Twist, TwistStamped};
use crate::node::{RosNode, qos};
use trundle_core::Twist2;

/// Calls `handler` in the node's thread with each twist of a topic; `None` for a twist that is not usable, after a report.
///
/// # Errors
/// When the name is not allowed or the topic cannot be created.
pub fn subscribe_twists(
    node: &mut RosNode,
    topic: &str,
    is_stamped: bool,
    mut handler: impl FnMut(Option<Twist2>) + Send + 'static,
) -> Result<(), Ros2Error> {
    let (diagnostics, name) = (node.diagnostics(), node.names().resolve(topic));
    let mut take = move |message: &Twist| {
        handler(twist::from_ros(message).map_err(|error| diagnostics.warn(&name, error.to_string())).ok());
    };
    if is_stamped {
        node.subscribe(topic, &qos::reliable(1), None, move |message: TwistStamped| take(&message.twist))?;
    } else {
        node.subscribe(topic, &qos::reliable(1), None, move |message: Twist| take(&message))?;
    }
    Ok(())
}
