//! Driving by keys in the terminal.

use super::driver::SimDriver;
use super::steering::Steering;
use super::steering_keys::steering_key;
use super::terminal::{self, RawTerminal};
use trundle_app::AppError;
use trundle_core::{Pose2, Stamp, Twist2};

/// A driver at the keys of the terminal.
#[derive(Debug)]
pub struct KeyDriver {
    steering: Steering,
    terminal: RawTerminal,
}

impl KeyDriver {
    /// The keys in a sentence.
    pub const HELP: &'static str = "Arrows or WASD: faster, slower, left, right. Space: stop. Q: quit.";

    /// Refuses keyboard driving without a terminal.
    ///
    /// # Errors
    /// When standard input is no terminal.
    pub fn require_terminal() -> Result<(), AppError> {
        terminal::require()
    }

    /// Starts to read keys. A drop restores the terminal.
    ///
    /// # Errors
    /// When the terminal refuses raw mode.
    pub fn start() -> Result<Self, AppError> {
        Ok(Self { steering: Steering::default(), terminal: RawTerminal::new()? })
    }
}

impl SimDriver for KeyDriver {
    fn twist(&mut self, _stamp: Stamp, _pose: Pose2) -> Result<Twist2, AppError> {
        let keys = self.terminal.pressed()?.into_iter().filter_map(steering_key);
        keys.for_each(|key| self.steering.press(key));
        Ok(self.steering.twist())
    }

    fn end_s(&self) -> Option<f64> {
        self.steering.has_quit().then_some(0.0)
    }
}
