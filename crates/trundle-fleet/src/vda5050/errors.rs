//! The errors reported until the robot accepts an order.

use super::message::ErrorReport;

/// Maximum number of errors in a state. Source: ours; older ones are dropped.
const MAX_ERRORS: usize = 10;

/// The errors reported until the robot accepts an order.
#[derive(Debug, Default)]
pub struct ErrorBook {
    errors: Vec<ErrorReport>,
}

impl ErrorBook {
    /// Adds an error; an existing one moves to the end.
    pub fn add(&mut self, error: ErrorReport) {
        tracing::debug!("VDA 5050: {}: {}", error.error_type, error.error_description);
        self.errors.retain(|known| *known != error);
        self.errors.push(error);
        if self.errors.len() > MAX_ERRORS {
            self.errors.remove(0);
        }
    }

    /// Adds an error and removes the others of its type.
    pub fn replace(&mut self, error: ErrorReport) {
        self.remove(&error.error_type.clone());
        self.add(error);
    }

    /// Removes the errors of a type.
    pub fn remove(&mut self, error_type: &str) {
        self.errors.retain(|known| known.error_type != error_type);
    }

    /// Removes all errors.
    pub fn clear(&mut self) {
        self.errors.clear();
    }

    /// The errors, oldest first.
    #[must_use]
    pub fn all(&self) -> &[ErrorReport] {
        &self.errors
    }
}
