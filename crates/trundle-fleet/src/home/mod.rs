//! A robot at home: state, map picture and commands, and Home Assistant's discovery.

mod command;
mod discovery;
mod home_state;
mod map_picture;
mod steering;

pub use command::{HomeCommand, read_home_command};

use crate::broker::Publication;
use crate::robot_commands::RobotCommands;
use crate::robot_status::RobotStatus;
use crate::{Places, RobotFacts, RobotName};
use discovery::{DiscoveryTopics, discovery};
use home_state::HomeState;
use map_picture::MapPictures;
use serde_json::json;
use std::time::Duration;
use trundle_app::operator::MapView;

/// Time between two states while the robot moves. Source: ours.
const STATE_PERIOD: Duration = Duration::from_secs(1);

/// A robot at home.
pub struct Home {
    name: RobotName,
    topics: DiscoveryTopics,
    facts: RobotFacts,
    places: Box<dyn Places>,
    known_places: Vec<String>,
    pictures: MapPictures,
    sent: Option<HomeState>,
    since_state: Duration,
    /// Whether the discovery waits to be sent.
    is_new: bool,
    replies: Vec<Publication>,
}

impl Home {
    /// The robot `name`. The broker publishes the robot's connection state on `connection_topic`.
    pub fn new(
        name: &RobotName,
        facts: RobotFacts,
        places: Box<dyn Places>,
        connection_topic: String,
    ) -> Self {
        Self {
            name: name.clone(),
            topics: DiscoveryTopics::of(name, connection_topic),
            facts,
            places,
            known_places: Vec::new(),
            pictures: MapPictures::default(),
            sent: None,
            since_state: Duration::ZERO,
            is_new: false,
            replies: Vec::new(),
        }
    }

    /// The topics of commands.
    pub fn topics(&self) -> Vec<String> {
        vec![self.topics.command.clone()]
    }

    /// Whether the next picture needs a new map.
    pub fn wants_map(&self) -> bool {
        self.pictures.is_due()
    }

    /// The broker accepted the robot: all messages are sent again.
    pub fn on_joined(&mut self) {
        self.is_new = true;
        self.sent = None;
        self.pictures.begin_anew();
    }

    /// Handles a message; a refused one is answered with the reason.
    pub fn on_message(
        &mut self,
        topic: &str,
        payload: &[u8],
        view: &RobotStatus,
        robot: &mut dyn RobotCommands,
    ) {
        if topic != self.topics.command {
            return;
        }
        let done = read_home_command(payload)
            .and_then(|command| steering::execute(&command, view, self.places.as_ref(), robot));
        let reply = match done {
            Ok(text) => json!({ "accepted": true, "text": text }),
            Err(text) => json!({ "accepted": false, "text": text }),
        };
        self.replies.push(Publication::json(self.topics.reply.clone(), &reply, false));
    }

    /// The messages that are due.
    pub fn publications(
        &mut self,
        passed: Duration,
        view: &RobotStatus,
        map: Option<&MapView>,
    ) -> Vec<Publication> {
        self.since_state += passed;
        let mut due = std::mem::take(&mut self.replies);
        let places = self.places.names();
        if std::mem::take(&mut self.is_new) || places != self.known_places {
            let discovered = discovery(&self.name, &self.facts, &self.topics, &places);
            due.push(Publication::json(self.topics.discovery.clone(), &discovered, true));
            self.known_places = places;
        }
        due.extend(self.due_state(view));
        let picture = self.pictures.due(passed, map, view.estimate.pose, &self.facts);
        due.extend(picture.map(|payload| Publication {
            topic: self.topics.map.clone(),
            payload,
            is_retained: true,
        }));
        due
    }

    fn due_state(&mut self, view: &RobotStatus) -> Option<Publication> {
        let state = HomeState::of(view);
        let is_due = match &self.sent {
            None => true,
            Some(sent) => !state.is_like(sent) || (state != *sent && self.since_state >= STATE_PERIOD),
        };
        if !is_due {
            return None;
        }
        let publication = Publication::json(self.topics.state.clone(), &state, true);
        (self.sent, self.since_state) = (Some(state), Duration::ZERO);
        Some(publication)
    }
}
