//! A numbered command of an operator.

use serde::{Deserialize, Serialize};
use trundle_runtime::OperatorCommand;

/// A command of an operator, with its number. Views identify the mission of a command by this number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OperatorRequest {
    /// Number of the request, from 1, in the order of sending.
    pub id: u64,
    /// The command.
    pub command: OperatorCommand,
}
