//! Keys of the terminal, without waiting for Enter.

use crossterm::event::{Event, KeyEvent, KeyEventKind, poll, read};
use crossterm::terminal::{disable_raw_mode, enable_raw_mode};
use std::io::IsTerminal;
use std::time::Duration;
use trundle_app::AppError;

/// The terminal in raw mode: each key is delivered immediately, without echo. A drop restores the terminal.
#[derive(Debug)]
pub struct RawTerminal(());

/// Refuses a standard input that is not a terminal.
pub fn require() -> Result<(), AppError> {
    if std::io::stdin().is_terminal() {
        Ok(())
    } else {
        Err(AppError::Input("--keys reads the keyboard, but standard input is not a terminal".to_owned()))
    }
}

impl RawTerminal {
    /// Starts raw mode.
    ///
    /// # Errors
    /// When the terminal refuses.
    pub fn new() -> Result<Self, AppError> {
        enable_raw_mode().map(|()| Self(())).map_err(refused)
    }

    /// The keys pressed since the last call, without waiting.
    ///
    /// # Errors
    /// When the terminal is closed.
    pub fn pressed(&mut self) -> Result<Vec<KeyEvent>, AppError> {
        let mut keys = Vec::new();
        while poll(Duration::ZERO).map_err(refused)? {
            match read().map_err(refused)? {
                Event::Key(key) if key.kind != KeyEventKind::Release => keys.push(key),
                _ => {}
            }
        }
        Ok(keys)
    }
}

impl Drop for RawTerminal {
    fn drop(&mut self) {
        let _ = disable_raw_mode();
    }
}

fn refused(error: std::io::Error) -> AppError {
    AppError::Environment(format!("the terminal gives no keys: {error}"))
}
