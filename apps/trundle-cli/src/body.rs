use crate::failure::Failure;
use trundle::core::{RobotBody, Twist2};
use trundle::io::{EncodedEvent, RecordedMessage, RecordingReader};
use trundle::sim::Simulator;

/// A body behind the wire: its events arrive encoded, as they are recorded.
pub trait WiredBody {
    /// The next event; `None` at the end.
    fn next_event(&mut self) -> Result<Option<EncodedEvent>, Failure>;

    /// Asks the base to move.
    fn command(&mut self, twist: Twist2) -> Result<(), Failure>;
}

impl WiredBody for Simulator {
    fn next_event(&mut self) -> Result<Option<EncodedEvent>, Failure> {
        let event = RobotBody::next_event(self).map_err(|error| Failure::Input(error.to_string()))?;
        event.map(|event| EncodedEvent::encode(&event)).transpose().map_err(|e| Failure::Input(e.to_string()))
    }

    fn command(&mut self, twist: Twist2) -> Result<(), Failure> {
        RobotBody::command(self, twist).map_err(|error| Failure::Input(error.to_string()))
    }
}

impl WiredBody for RecordingReader {
    fn next_event(&mut self) -> Result<Option<EncodedEvent>, Failure> {
        loop {
            match self.next_message()? {
                Some(RecordedMessage::Event(event)) => return Ok(Some(event)),
                Some(RecordedMessage::Json { .. }) => {}
                None => return Ok(None),
            }
        }
    }

    /// What was driven was driven.
    fn command(&mut self, _twist: Twist2) -> Result<(), Failure> {
        Ok(())
    }
}
