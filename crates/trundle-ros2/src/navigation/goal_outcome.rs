//! Outcome of a goal.

use trundle_runtime::{Reason, TaskEnd};

/// Outcome of a goal, for its result.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NavigationOutcome {
    /// The problem, in words; empty without one.
    pub message: String,
    /// Reason why the robot failed.
    pub reason: Option<Reason>,
    /// Tasks of the goal that ended, by their index, in the order of their ends. A task that was put off may end again.
    pub ended: Vec<(usize, TaskEnd)>,
    /// Whether the time that was allowed is over.
    pub is_timeout: bool,
}

impl NavigationOutcome {
    /// A failure without a reason of the robot.
    #[must_use]
    pub fn failed(message: &str) -> Self {
        Self { message: message.to_owned(), ..Self::default() }
    }

    /// A failure for a reason of the robot.
    #[must_use]
    pub fn of_reason(reason: Reason) -> Self {
        Self { reason: Some(reason.clone()), ..Self::failed(&reason.to_string()) }
    }

    /// The outcome of a goal replaced by another.
    #[must_use]
    pub fn replaced() -> Self {
        Self::failed("a newer goal replaced it")
    }

    /// The time that was allowed is over.
    #[must_use]
    pub fn timed_out() -> Self {
        Self { is_timeout: true, ..Self::failed("the time that was allowed is over") }
    }

    /// The tasks that the robot gave up.
    pub fn missed(&self) -> impl DoubleEndedIterator<Item = (usize, &Reason)> {
        self.ended.iter().filter_map(|(index, end)| match end {
            TaskEnd::GivenUp { reason } => Some((*index, reason)),
            _ => None,
        })
    }

    /// The error code: `none` for a success, `timeout`, or that of the reason.
    #[must_use]
    pub fn code(&self, timeout: u16, of_reason: impl Fn(&Reason) -> u16, unknown: u16) -> u16 {
        match (&self.reason, self.is_timeout, self.message.is_empty()) {
            (_, true, _) => timeout,
            (Some(reason), ..) => of_reason(reason),
            (None, _, true) => 0,
            (None, _, false) => unknown,
        }
    }
}
