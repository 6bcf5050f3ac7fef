//! The header of every message, and the topics.

use crate::timestamp::utc_text;
use serde::{Deserialize, Serialize};
use std::time::SystemTime;

/// Version of the protocol.
pub const PROTOCOL_VERSION: &str = "2.1.0";
/// Major version in topics.
const MAJOR_VERSION: &str = "v2";
/// First part of every topic. Source: VDA 5050 2.1, section 6.4.
const INTERFACE_NAME: &str = "uagv";

/// The topics of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// An order of the master.
    Order,
    /// Instant actions of the master.
    InstantActions,
    /// State of the robot.
    State,
    /// Position of the robot, sent more often than the state.
    Visualization,
    /// Whether the robot is connected, sent by the robot and the broker.
    Connection,
    /// Abilities of the robot.
    Factsheet,
}

impl Topic {
    /// Number of topics. Source: VDA 5050 2.1.
    const COUNT: usize = 6;

    /// Last part of the topic.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Order => "order",
            Self::InstantActions => "instantActions",
            Self::State => "state",
            Self::Visualization => "visualization",
            Self::Connection => "connection",
            Self::Factsheet => "factsheet",
        }
    }
}

/// Name of a robot in topics and messages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// Manufacturer.
    pub manufacturer: String,
    /// Serial number.
    pub serial_number: String,
}

impl Identity {
    /// The whole name of a topic.
    #[must_use]
    pub fn topic(&self, topic: Topic) -> String {
        format!(
            "{INTERFACE_NAME}/{MAJOR_VERSION}/{}/{}/{}",
            self.manufacturer,
            self.serial_number,
            topic.name()
        )
    }
}

/// The header of a message.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct MessageHeader {
    /// Number of the message in its topic.
    pub header_id: u32,
    /// Time of sending: ISO 8601, UTC.
    pub timestamp: String,
    /// Version of the protocol.
    pub version: String,
    /// Manufacturer of the robot.
    pub manufacturer: String,
    /// Serial number of the robot.
    pub serial_number: String,
}

/// Numbers the messages of a robot, each topic from 0.
#[derive(Debug)]
pub struct HeaderCounter {
    identity: Identity,
    next: [u32; Topic::COUNT],
}

impl HeaderCounter {
    /// The counter of a robot.
    #[must_use]
    pub fn new(identity: Identity) -> Self {
        Self { identity, next: [0; Topic::COUNT] }
    }

    /// The robot.
    #[must_use]
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// The header of the next message of a topic.
    pub fn header(&mut self, topic: Topic) -> MessageHeader {
        let next = &mut self.next[topic as usize];
        let header_id = *next;
        *next = next.wrapping_add(1);
        MessageHeader {
            header_id,
            timestamp: utc_text(SystemTime::now()),
            version: PROTOCOL_VERSION.to_owned(),
            manufacturer: self.identity.manufacturer.clone(),
            serial_number: self.identity.serial_number.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_topic_counts_its_own_messages() {
        let identity = Identity { manufacturer: "trundle".to_owned(), serial_number: "r1".to_owned() };
        assert_eq!(identity.topic(Topic::InstantActions), "uagv/v2/trundle/r1/instantActions");
        let mut counter = HeaderCounter::new(identity);
        let mut id = |topic| counter.header(topic).header_id;
        assert_eq!([id(Topic::State), id(Topic::State), id(Topic::Factsheet)], [0, 1, 0]);
    }
}
