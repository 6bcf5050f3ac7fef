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
    /// The user ends the run.
    Interrupted,
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

    /// How often it has touched something by now, in truth; `None` where only its bumper says so.
    fn contacts(&self) -> Option<u32>;
}

/// What a recording says between the events: of the robot's body, and of work that a robot gives out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mark {
    /// What came of this helper's work was taken up here.
    TakenUp(Helper),
    /// The body had touched something so often by now, in truth: before the event that follows.
    Contacts(u32),
    /// The user ended the run.
    Interrupted,
    /// The run was over; what follows was still under way.
    End,
}

impl Mark {
    /// Where it is recorded.
    pub const TOPIC: &str = "/mark";
    /// The name of its schema.
    pub const SCHEMA: &str = "trundle.Mark";
}

/// A mark as it is recorded.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct MarkMessage {
    /// What it says.
    pub mark: Mark,
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

    fn contacts(&self) -> Option<u32> {
        Some(Self::contacts(self))
    }
}

/// A recording fed again. Work is done when the recording says that it was taken up.
pub struct Recorded {
    reader: RecordingReader,
    jobs: BTreeMap<Helper, Job>,
    contacts: Option<u32>,
}

impl Recorded {
    /// From the recording's beginning.
    pub fn new(reader: RecordingReader) -> Self {
        Self { reader, jobs: BTreeMap::new(), contacts: None }
    }

    /// Whether the rest, which no run needs, can be read to its end.
    pub fn read_on(&mut self) -> Result<(), Failure> {
        while self.reader.next_message()?.is_some() {}
        Ok(())
    }

    /// What a mark says.
    fn read(value: serde_json::Value) -> Result<Mark, Failure> {
        let message: MarkMessage = serde_json::from_value(value)
            .map_err(|error| Failure::Input(format!("message on {}: {error}", Mark::TOPIC)))?;
        Ok(message.mark)
    }

    /// What came of the helper's work, which is done now.
    fn answer_of(&mut self, helper: Helper) -> Result<Option<Input>, Failure> {
        let answer = self.last_answer(helper).ok_or_else(|| {
            Failure::Input(format!("message on {}: {helper:?} has nothing to do here", Mark::TOPIC))
        })?;
        Ok(Some(Input::Answer(answer)))
    }
}

impl WiredBody for Recorded {
    fn next_input(&mut self) -> Result<Option<Input>, Failure> {
        loop {
            match self.reader.next_message()? {
                Some(RecordedMessage::Event(event)) => return Ok(Some(Input::Event(event))),
                Some(RecordedMessage::Json { schema, value, .. }) if schema == Mark::SCHEMA => {
                    match Self::read(value)? {
                        Mark::Contacts(count) => self.contacts = Some(count),
                        Mark::TakenUp(helper) => return self.answer_of(helper),
                        Mark::Interrupted => return Ok(Some(Input::Interrupted)),
                        Mark::End => return Ok(None),
                    }
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

    fn contacts(&self) -> Option<u32> {
        self.contacts
    }
}
