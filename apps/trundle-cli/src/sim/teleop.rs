//! Driving by keys in the terminal.

mod keys;
mod terminal;

use crate::console;
use keys::steering_key;
use terminal::RawTerminal;
use trundle::app::AppError;
use trundle::core::{Pose2, Stamp, Twist2};
use trundle::experiments::sim_drive::{SimDriver, Steering};

/// A driver at the keys of the terminal.
pub struct KeyDriver {
    steering: Steering,
    terminal: RawTerminal,
}

/// Refuses to drive by keys where there is no terminal to read them from.
///
/// # Errors
/// When standard input is no terminal.
pub fn require_terminal() -> Result<(), AppError> {
    terminal::require()
}

impl KeyDriver {
    /// Starts to read keys.
    ///
    /// # Errors
    /// When the terminal gives no keys.
    pub fn start(quiet: bool) -> Result<Self, AppError> {
        if !quiet {
            console::print("Arrows or WASD: faster, slower, left, right. Space: stop. Q: quit.");
        }
        Ok(Self { steering: Steering::default(), terminal: RawTerminal::new()? })
    }
}

impl SimDriver for KeyDriver {
    fn twist(&mut self, _stamp: Stamp, _pose: Pose2) -> Result<Twist2, AppError> {
        self.terminal
            .pressed()?
            .into_iter()
            .filter_map(steering_key)
            .for_each(|key| self.steering.press(key));
        Ok(self.steering.twist())
    }

    fn end_s(&self) -> Option<f64> {
        self.steering.has_quit().then_some(0.0)
    }
}
