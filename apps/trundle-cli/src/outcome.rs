//! Whether a command reached its aim.

/// Whether a command that ran to its end reached its aim.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Exit code 0.
    Reached,
    /// Exit code 1.
    Missed,
}
