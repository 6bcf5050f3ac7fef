//! Marks in a recording between the events, by which a replay feeds the robot in the same order.

use crate::operator::OperatorRequest;
use serde::{Deserialize, Serialize};
use trundle_runtime::Worker;

/// A mark of a recording, between the events.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RunMark {
    /// The result of this worker's job was applied here.
    #[serde(rename = "taken_up")]
    Applied(Worker),
    /// Separate contacts so far, in truth, before the event that follows.
    Contacts(u32),
    /// The robot followed this request here.
    Operator(OperatorRequest),
    /// The user ended the run.
    Interrupted,
    /// The run was over; the following jobs were still running.
    End,
}

impl RunMark {
    /// The topic of marks.
    pub const TOPIC: &str = "/mark";
    /// Name of the schema of marks.
    pub const SCHEMA: &str = "trundle.Mark";
}

/// A mark in the format of the recording.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RunMarkMessage {
    /// The mark.
    pub mark: RunMark,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_keep_their_names_in_recordings() {
        let text = |mark| serde_json::to_string(&RunMarkMessage { mark }).unwrap();
        assert_eq!(text(RunMark::Contacts(2)), r#"{"mark":{"contacts":2}}"#);
        assert_eq!(text(RunMark::End), r#"{"mark":"end"}"#);
        assert!(text(RunMark::Applied(Worker::ALL[0])).starts_with(r#"{"mark":{"taken_up":""#));
    }
}
