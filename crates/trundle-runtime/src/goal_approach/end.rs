//! End of a final approach by turns and straight moves.

use serde::{Serialize, Serializer};
use std::fmt;
use trundle_docking::PositionerReason;

/// End of a final approach by turns and straight moves. Files contain its text.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ApproachEnd {
    /// The robot is at the goal, within tolerance.
    Settled,
    /// Another decision replaced the approach.
    BrokenOff,
    /// The approach is abandoned.
    GivenUp(ApproachFailure),
}

/// Reason why a final approach by turns and straight moves is abandoned.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ApproachFailure {
    /// No goal was given.
    NoGoal,
    /// The time limit is over.
    Timeout {
        /// The time limit \[s\].
        limit: f64,
    },
    /// The number of stops exceeds its limit; the reason is that of the last stop.
    Positioner(PositionerReason),
}

impl Serialize for ApproachEnd {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl fmt::Display for ApproachEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Settled => f.write_str("settled"),
            Self::BrokenOff => f.write_str("broken off"),
            Self::GivenUp(failure) => failure.fmt(f),
        }
    }
}

impl fmt::Display for ApproachFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoGoal => f.write_str("no goal to settle on"),
            Self::Timeout { limit } => write!(f, "not settled within {limit} s"),
            Self::Positioner(reason) => write_positioner_reason(reason, f),
        }
    }
}

fn write_positioner_reason(reason: &PositionerReason, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    match reason {
        PositionerReason::Obstacle(by) => write!(f, "{by} is in the way during the final approach"),
        PositionerReason::NoWay(Some(by)) => {
            write!(f, "no turns and straight moves lead to the goal: {by} is in the way")
        }
        PositionerReason::NoWay(None) => f.write_str("no turns and straight moves to the goal were found"),
        PositionerReason::Refused(refusal) => write!(f, "{refusal}"),
        PositionerReason::BadPose => f.write_str("the pose is not a number"),
        PositionerReason::Planning => {
            f.write_str("the search for turns and straight moves did not come to an end")
        }
        _ => f.write_str("stopped too often"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_docking::Motion;

    #[test]
    fn each_end_is_a_text_in_files() {
        let timeout = ApproachFailure::Timeout { limit: 120.0 };
        let ends = [
            (ApproachEnd::Settled, "settled"),
            (ApproachEnd::BrokenOff, "broken off"),
            (ApproachEnd::GivenUp(timeout), "not settled within 120 s"),
            (ApproachEnd::GivenUp(ApproachFailure::NoGoal), "no goal to settle on"),
        ];
        for (end, text) in ends {
            assert_eq!(end.to_string(), text);
            assert_eq!(serde_json::to_value(&end).unwrap(), text);
        }
    }

    #[test]
    fn the_last_stop_of_the_positioner_is_the_reason() {
        let text = |reason| ApproachFailure::Positioner(reason).to_string();
        assert_eq!(text(PositionerReason::BadPose), "the pose is not a number");
        assert_eq!(text(PositionerReason::NoWay(None)), "no turns and straight moves to the goal were found");
        let standing = [PositionerReason::Measuring, PositionerReason::Settled];
        for reason in standing.into_iter().chain([PositionerReason::Moving(Motion::Drive(0.1))]) {
            assert_eq!(text(reason), "stopped too often");
        }
    }
}
