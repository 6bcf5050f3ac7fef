//! Messages to a broker and from it.

use serde::Serialize;

/// A message to a broker.
#[derive(Debug, Clone)]
pub struct Publication {
    /// Topic of the message.
    pub topic: String,
    /// Payload of the message.
    pub payload: Vec<u8>,
    /// Whether the broker stores it for later subscribers.
    pub is_retained: bool,
}

impl Publication {
    /// A message with a payload of JSON. A value that cannot be written is a fault of this crate, and is logged.
    pub fn json(topic: String, value: &impl Serialize, is_retained: bool) -> Self {
        let payload = serde_json::to_vec(value).unwrap_or_else(|error| {
            tracing::error!("MQTT: {topic}: {error}");
            b"{}".to_vec()
        });
        Self { topic, payload, is_retained }
    }
}

/// Events of a connection.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum BrokerEvent {
    /// The broker accepted the robot.
    Joined,
    /// A message on a topic to which the robot subscribes.
    Message {
        /// Topic of the message.
        topic: String,
        /// Payload of the message.
        payload: Vec<u8>,
    },
    /// The connection ended, or could not begin.
    Lost(String),
}
