//! A session with a broker: from the connection to its end.

use super::event::{BrokerEvent, Publication};
use super::reader::read;
use crate::{BrokerAddress, Password};
use rumqttc::{Client, LastWill, MqttOptions, QoS, SubscribeFilter};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

/// Maximum number of messages waiting for the robot. While the queue is full, the broker is not read. Source: ours.
const MAX_WAITING_EVENTS: usize = 64;
/// Largest number of messages that wait for the broker; further messages are refused. Source: ours.
const MAX_WAITING_PUBLICATIONS: usize = 64;
/// Largest packet that is read \[bytes\]. A larger one ends the session. Source: ours, four times the largest order.
const MAX_PACKET_BYTES: usize = 1024 * 1024;
/// Largest packet that is sent \[bytes\]: a picture of a map of 3000 x 3000 cells. Source: ours.
const MAX_SENT_BYTES: usize = 16 * 1024 * 1024;
/// Time of silence after which each side checks the other. Source: ours.
const KEEP_ALIVE: Duration = Duration::from_secs(10);
/// Time in which the last message leaves. Source: ours.
const FAREWELL_TIME: Duration = Duration::from_secs(1);

/// Parts of a session.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SessionOptions {
    /// Name of this client, unique on a broker.
    pub client_id: String,
    /// The broker.
    pub address: BrokerAddress,
    /// The password.
    pub password: Option<Password>,
    /// Topics to which the robot subscribes.
    pub topics: Vec<String>,
    /// Message that the broker publishes when it loses the robot.
    pub last_will: Publication,
}

/// A session with a broker.
pub struct Session {
    client: Client,
    events: Receiver<BrokerEvent>,
    topics: Vec<String>,
}

impl Session {
    /// Starts to connect, on a thread.
    ///
    /// # Errors
    /// When the system refuses the thread.
    pub fn begin(options: &SessionOptions) -> std::io::Result<Self> {
        let (client, connection) = Client::new(client_options(options), MAX_WAITING_PUBLICATIONS);
        let (sender, events) = sync_channel(MAX_WAITING_EVENTS);
        let reader = std::thread::Builder::new().name("mqtt".to_owned());
        reader.spawn(move || read(connection, &sender))?;
        Ok(Self { client, events, topics: options.topics.clone() })
    }

    /// The events until a time, at most `max`.
    pub fn events(&self, until: Instant, max: usize) -> Vec<BrokerEvent> {
        let mut events = Vec::new();
        while events.len() < max {
            match self.events.recv_timeout(until.saturating_duration_since(Instant::now())) {
                Ok(event) => events.push(event),
                Err(RecvTimeoutError::Timeout) => break,
                Err(RecvTimeoutError::Disconnected) => {
                    events.push(BrokerEvent::Lost("the connection ended".to_owned()));
                    break;
                }
            }
        }
        if events.contains(&BrokerEvent::Joined) && !self.subscribe() {
            events.push(BrokerEvent::Lost("the broker takes no subscription".to_owned()));
        }
        events
    }

    fn subscribe(&self) -> bool {
        let filter = |topic: &String| SubscribeFilter::new(topic.clone(), QoS::AtLeastOnce);
        self.client.try_subscribe_many(self.topics.iter().map(filter)).is_ok()
    }

    /// Sends a message. Returns whether the queue had space. A retained message is delivered at least once.
    pub fn publish(&self, publication: Publication) -> bool {
        let Publication { topic, payload, is_retained } = publication;
        let quality = if is_retained { QoS::AtLeastOnce } else { QoS::AtMostOnce };
        self.client.try_publish(topic, quality, is_retained, payload).is_ok()
    }

    /// Sends a last message and ends the session.
    pub fn leave(self, last: Publication) {
        self.publish(last);
        if self.client.try_disconnect().is_err() {
            return;
        }
        let until = Instant::now() + FAREWELL_TIME;
        let is_lost =
            |events: &[BrokerEvent]| events.iter().any(|event| matches!(event, BrokerEvent::Lost(_)));
        while Instant::now() < until && !is_lost(&self.events(until, 1)) {}
    }
}

impl Drop for Session {
    /// A session that has ended already sends no last message.
    fn drop(&mut self) {
        _ = self.client.try_disconnect();
    }
}

fn client_options(options: &SessionOptions) -> MqttOptions {
    let address = &options.address;
    let mut client = MqttOptions::new(&options.client_id, &address.host, address.port);
    let Publication { topic, payload, is_retained } = options.last_will.clone();
    client
        .set_keep_alive(KEEP_ALIVE)
        .set_max_packet_size(MAX_PACKET_BYTES, MAX_SENT_BYTES)
        .set_last_will(LastWill::new(topic, payload, QoS::AtLeastOnce, is_retained));
    if let Some(user) = &address.user {
        client.set_credentials(user, options.password.as_ref().map(Password::text).unwrap_or_default());
    }
    client
}
