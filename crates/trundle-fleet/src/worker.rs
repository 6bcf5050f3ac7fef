//! The thread that brings broker, home and master together.

use crate::broker::{Broker, BrokerEvent, SessionOptions};
use crate::home::Home;
use crate::master_link::MasterLink;
use crate::vda5050::message::ConnectionState;
use crate::{FleetOptions, RobotFacts, RobotStatus};
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_app::operator::{Operator, RunView};
use trundle_runtime::real_time::ThreadPlacement;

/// Period of reading views of the run. Source: ours.
const LOOK_PERIOD: Duration = Duration::from_millis(50);
/// Largest number of messages that are handled in a period; more wait at the broker. Source: ours.
const MAX_MESSAGES_OF_PERIOD: usize = 200;

/// Brings broker, home and master together.
pub struct FleetWorker {
    operator: Operator,
    broker: Broker,
    home: Home,
    master: MasterLink,
    address: String,
    is_joined: bool,
    /// Whether the loss of the broker was reported.
    is_reported: bool,
}

impl FleetWorker {
    /// The worker of a robot.
    pub fn new(options: &FleetOptions, operator: Operator, facts: RobotFacts) -> Self {
        let places = Box::new(operator.clone());
        let master = MasterLink::new(options, facts.clone());
        let home = Home::new(&options.name, facts, places, master.connection_topic());
        let session = SessionOptions {
            client_id: format!("{}-{}", options.name.manufacturer, options.name.serial_number),
            address: options.broker.clone(),
            password: options.password.clone(),
            topics: [master.topics(), home.topics()].concat(),
            last_will: master.connection(ConnectionState::ConnectionBroken),
        };
        let (broker, address) = (Broker::new(session), options.broker.to_string());
        Self { operator, broker, home, master, address, is_joined: false, is_reported: false }
    }

    /// Works until `is_over`; then disconnects.
    pub fn run(mut self, is_over: impl Fn() -> bool) {
        // If the system refuses the niceness, the link works all the same.
        _ = ThreadPlacement { nice: crate::broker::LINK_NICENESS, ..ThreadPlacement::default() }.take();
        let mut last = Instant::now();
        while !is_over() {
            for event in self.broker.events(LOOK_PERIOD, MAX_MESSAGES_OF_PERIOD) {
                self.on_event(event);
            }
            let passed = last.elapsed();
            last += passed;
            self.step(passed);
        }
        if self.is_joined {
            let last = self.master.connection(ConnectionState::Offline);
            self.broker.leave(last);
        }
    }

    fn on_event(&mut self, event: BrokerEvent) {
        match event {
            BrokerEvent::Joined => {
                let address = &self.address;
                if self.is_reported {
                    tracing::warn!("MQTT: connected to {address} again");
                } else {
                    tracing::info!("MQTT: connected to {address}");
                }
                (self.is_joined, self.is_reported) = (true, false);
                self.master.on_joined();
                self.home.on_joined();
            }
            BrokerEvent::Lost(reason) => {
                if !self.is_reported {
                    let address = &self.address;
                    tracing::warn!(
                        "MQTT: no connection to {address} ({reason}): the robot continues and tries again"
                    );
                }
                (self.is_joined, self.is_reported) = (false, true);
            }
            BrokerEvent::Message { topic, payload } => self.on_message(&topic, &payload),
        }
    }

    fn on_message(&mut self, topic: &str, payload: &[u8]) {
        // A command before the first view is ignored: the robot has no pose.
        let Some(view) = self.operator.peek() else {
            return tracing::debug!("MQTT: a message before the first view");
        };
        let view = RobotStatus::from(&*view);
        if !self.master.on_message(topic, payload, &view, &mut self.operator) {
            self.home.on_message(topic, payload, &view, &mut self.operator);
        }
    }

    fn step(&mut self, passed: Duration) {
        let Some(run) = self.view() else { return };
        let view = RobotStatus::from(&*run);
        self.master.step(passed, &view, &mut self.operator);
        if !self.is_joined {
            return;
        }
        let publications = [
            self.master.publications(passed, &view),
            self.home.publications(passed, &view, run.map.as_deref()),
        ];
        for publication in publications.into_iter().flatten() {
            let topic = publication.topic.clone();
            if !self.broker.publish(publication) {
                tracing::debug!("MQTT: the broker is slow: {topic} was not sent");
            }
        }
    }

    /// The newest view. The map is only requested when a picture is due.
    fn view(&self) -> Option<Arc<RunView>> {
        if self.is_joined && self.home.wants_map() { self.operator.view() } else { self.operator.peek() }
    }
}
