use crate::failure::Failure;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use trundle::core::{RobotBody, Twist2};
use trundle::io::{EncodedEvent, RecordedMessage, RecordingReader};
use trundle::runtime::{Answer, Helper, Job};
use trundle::sim::Simulator;

/// What a run is fed.
pub enum Input {
    /// What a sensor says, encoded as it is recorded.
    Event(EncodedEvent),
    /// What came of work in the background.
    Answer(Answer),
}

/// A body behind the wire: its events arrive encoded, as they are recorded. The robot's long work, where it gives any out, is done
/// beside it.
pub trait WiredBody {
    /// What comes next; `None` at the end.
    fn next_input(&mut self) -> Result<Option<Input>, Failure>;

    /// Asks the base to move.
    fn command(&mut self, twist: Twist2) -> Result<(), Failure>;

    /// Takes work of a robot that gives its long work out.
    fn give(&mut self, job: Job);

    /// What came of a helper's work that is still under way, at the end of a run; `None` where there is none.
    fn last_answer(&mut self, helper: Helper) -> Option<Answer>;
}

/// The mark in a recording that work was taken up here, or that the run ended here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TakenUp {
    /// Whose; none at the end of the run.
    pub helper: Option<Helper>,
}

impl TakenUp {
    /// Where it is recorded.
    pub const TOPIC: &str = "/taken_up";
    /// The name of its schema.
    pub const SCHEMA: &str = "trundle.TakenUp";
}

impl WiredBody for Simulator {
    fn next_input(&mut self) -> Result<Option<Input>, Failure> {
        let event = RobotBody::next_event(self).map_err(|error| Failure::Input(error.to_string()))?;
        let event = event.map(|event| EncodedEvent::encode(&event)).transpose();
        Ok(event.map_err(|error| Failure::Input(error.to_string()))?.map(Input::Event))
    }

    fn command(&mut self, twist: Twist2) -> Result<(), Failure> {
        RobotBody::command(self, twist).map_err(|error| Failure::Input(error.to_string()))
    }

    /// In simulated time a robot works within its steps.
    fn give(&mut self, _job: Job) {}

    fn last_answer(&mut self, _helper: Helper) -> Option<Answer> {
        None
    }
}

/// A recording fed again. Work is done when the recording says that it was taken up.
pub struct Recorded {
    reader: RecordingReader,
    jobs: BTreeMap<Helper, Job>,
}

impl Recorded {
    /// From the recording's beginning.
    pub fn new(reader: RecordingReader) -> Self {
        Self { reader, jobs: BTreeMap::new() }
    }
}

impl WiredBody for Recorded {
    fn next_input(&mut self) -> Result<Option<Input>, Failure> {
        loop {
            match self.reader.next_message()? {
                Some(RecordedMessage::Event(event)) => return Ok(Some(Input::Event(event))),
                Some(RecordedMessage::Json { schema, value, .. }) if schema == TakenUp::SCHEMA => {
                    let mark: TakenUp = serde_json::from_value(value)
                        .map_err(|error| Failure::Input(format!("{}: {error}", TakenUp::TOPIC)))?;
                    let Some(helper) = mark.helper else { return Ok(None) };
                    let answer = self.last_answer(helper).ok_or_else(|| {
                        Failure::Input(format!("{}: {helper:?} had no work here", TakenUp::TOPIC))
                    })?;
                    return Ok(Some(Input::Answer(answer)));
                }
                Some(RecordedMessage::Json { .. }) => {}
                None => return Ok(None),
            }
        }
    }

    /// What was driven was driven.
    fn command(&mut self, _twist: Twist2) -> Result<(), Failure> {
        Ok(())
    }

    fn give(&mut self, job: Job) {
        self.jobs.insert(job.helper(), job);
    }

    fn last_answer(&mut self, helper: Helper) -> Option<Answer> {
        self.jobs.remove(&helper).map(Job::run)
    }
}
