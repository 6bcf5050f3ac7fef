//! Reason why a command is refused.

use trundle_app::operator::OperatorError;
use trundle_core::Invalid;

/// Reason why a command is refused.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandRefusal {
    /// The refusal in a sentence.
    pub text: String,
    /// Number of the goal that cannot be reached, from 0.
    pub goal: Option<usize>,
}

impl CommandRefusal {
    /// A refusal that no goal is the reason of.
    pub fn of(text: impl Into<String>) -> Self {
        Self { text: text.into(), goal: None }
    }
}

impl From<OperatorError> for CommandRefusal {
    fn from(error: OperatorError) -> Self {
        Self::of(error.to_string())
    }
}

impl From<Invalid> for CommandRefusal {
    fn from(error: Invalid) -> Self {
        Self::of(error.to_string())
    }
}
