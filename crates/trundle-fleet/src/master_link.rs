//! A vehicle on its topics: contents and times of a master control's messages.

use crate::broker::Publication;
use crate::robot_commands::RobotCommands;
use crate::robot_status::RobotStatus;
use crate::vda5050::limits::{MIN_STATE_PERIOD, MOVING_STATE_PERIOD, STATE_PERIOD, VISUALIZATION_PERIOD};
use crate::vda5050::message::{
    ConnectionMessage, ConnectionState, Factsheet, HeaderCounter, Identity, Topic, VehicleState,
    Visualization,
};
use crate::vda5050::{Vehicle, robot_position, vehicle_state, velocity};
use crate::{FleetOptions, RobotFacts};
use std::cell::RefCell;
use std::time::Duration;

/// A vehicle on its topics.
#[derive(Debug)]
pub struct MasterLink {
    vehicle: Vehicle,
    facts: RobotFacts,
    map_id: String,
    headers: RefCell<HeaderCounter>,
    /// The last state that was sent.
    sent: Option<VehicleState>,
    /// Time since the last state and since the last position.
    since_state: Duration,
    since_position: Duration,
    /// Whether connection state and factsheet wait to be sent.
    is_new: bool,
}

impl MasterLink {
    /// The link of a robot.
    #[must_use]
    pub fn new(options: &FleetOptions, facts: RobotFacts) -> Self {
        let name = options.name.clone();
        let identity = Identity { manufacturer: name.manufacturer, serial_number: name.serial_number };
        Self {
            vehicle: Vehicle::new(facts.clone(), &options.map_id),
            facts,
            map_id: options.map_id.clone(),
            headers: RefCell::new(HeaderCounter::new(identity)),
            sent: None,
            since_state: Duration::ZERO,
            since_position: Duration::ZERO,
            is_new: false,
        }
    }

    /// The topics that the master sends to.
    #[must_use]
    pub fn topics(&self) -> Vec<String> {
        vec![self.topic(Topic::Order), self.topic(Topic::InstantActions)]
    }

    /// The topic for the robot's connection state, published by the robot and the broker.
    #[must_use]
    pub fn connection_topic(&self) -> String {
        self.topic(Topic::Connection)
    }

    fn topic(&self, topic: Topic) -> String {
        self.headers.borrow().identity().topic(topic)
    }

    /// A message of the topic `connection`.
    #[must_use]
    pub fn connection(&self, connection_state: ConnectionState) -> Publication {
        let header = self.headers.borrow_mut().header(Topic::Connection);
        Publication::json(self.connection_topic(), &ConnectionMessage { header, connection_state }, true)
    }

    /// The broker accepted the robot: all messages are sent again.
    pub fn on_joined(&mut self) {
        self.is_new = true;
        self.sent = None;
    }

    /// Takes a message. Returns whether the topic is one of the master's.
    pub fn on_message(
        &mut self,
        topic: &str,
        payload: &[u8],
        view: &RobotStatus,
        robot: &mut dyn RobotCommands,
    ) -> bool {
        if topic == self.topic(Topic::Order) {
            self.vehicle.on_order(payload, view);
        } else if topic == self.topic(Topic::InstantActions) {
            self.vehicle.on_instant_actions(payload, view, robot);
        } else {
            return false;
        }
        true
    }

    /// Continues the order, also without a broker.
    pub fn step(&mut self, passed: Duration, view: &RobotStatus, robot: &mut dyn RobotCommands) {
        self.vehicle.step(passed, view, robot);
    }

    /// The messages that are due.
    pub fn publications(&mut self, passed: Duration, view: &RobotStatus) -> Vec<Publication> {
        self.since_state += passed;
        self.since_position += passed;
        let is_new = std::mem::take(&mut self.is_new);
        let mut due = Vec::new();
        if is_new {
            due.push(self.connection(ConnectionState::Online));
        }
        if self.vehicle.take_factsheet_wish() || is_new {
            let header = self.headers.borrow_mut().header(Topic::Factsheet);
            due.push(Publication::json(
                self.topic(Topic::Factsheet),
                &Factsheet::of(header, &self.facts),
                true,
            ));
        }
        due.extend(self.due_state(view));
        due.extend(self.due_position(view));
        due
    }

    /// The state if it changed or a repetition is due.
    fn due_state(&mut self, view: &RobotStatus) -> Option<Publication> {
        let is_wanted = self.vehicle.take_state_wish();
        if self.sent.is_some() && self.since_state < MIN_STATE_PERIOD && !is_wanted {
            return None;
        }
        let is_busy = |state: &VehicleState| state.driving || !state.order.node_states.is_empty();
        let period = |state: &VehicleState| if is_busy(state) { MOVING_STATE_PERIOD } else { STATE_PERIOD };
        let is_same = self.sent.as_ref().is_some_and(|sent| {
            let state = vehicle_state(&self.vehicle, sent.header.clone(), view);
            state.is_like(sent) && self.since_state < period(&state)
        });
        if is_same && !is_wanted {
            return None;
        }
        let header = self.headers.borrow_mut().header(Topic::State);
        let state = vehicle_state(&self.vehicle, header, view);
        let publication = Publication::json(self.topic(Topic::State), &state, false);
        (self.sent, self.since_state) = (Some(state), Duration::ZERO);
        Some(publication)
    }

    /// The position, often while the robot moves.
    fn due_position(&mut self, view: &RobotStatus) -> Option<Publication> {
        let is_driving = self.sent.as_ref().is_some_and(|state| state.driving);
        let period = if is_driving { VISUALIZATION_PERIOD } else { STATE_PERIOD };
        if self.since_position < period {
            return None;
        }
        self.since_position = Duration::ZERO;
        let header = self.headers.borrow_mut().header(Topic::Visualization);
        let (agv_position, velocity) = (robot_position(view, &self.map_id), velocity(view));
        let message = Visualization { header, agv_position, velocity };
        Some(Publication::json(self.topic(Topic::Visualization), &message, false))
    }
}
