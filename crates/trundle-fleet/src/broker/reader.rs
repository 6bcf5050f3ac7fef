//! The thread that carries a session.

use super::event::BrokerEvent;
use rumqttc::{Connection, Event, Packet};
use std::sync::mpsc::SyncSender;
use trundle_runtime::real_time::ThreadPlacement;

/// Niceness of the threads of this crate above that of the robot's threads. Source: ours.
pub(crate) const LINK_NICENESS: i32 = 10;

/// Runs a session until its first error, or until its events have no reader. A full queue stops reading from the broker.
pub fn read(mut connection: Connection, events: &SyncSender<BrokerEvent>) {
    // If the system refuses the niceness, the session continues without it.
    _ = ThreadPlacement { nice: LINK_NICENESS, ..ThreadPlacement::default() }.take();
    for event in connection.iter() {
        let event = match event {
            Ok(Event::Incoming(Packet::ConnAck(_))) => BrokerEvent::Joined,
            Ok(Event::Incoming(Packet::Publish(message))) => {
                BrokerEvent::Message { topic: message.topic, payload: message.payload.to_vec() }
            }
            Ok(_) => continue,
            Err(error) => {
                _ = events.send(BrokerEvent::Lost(error.to_string()));
                return;
            }
        };
        if events.send(event).is_err() {
            return;
        }
    }
}
