use crossterm::event::{Event, KeyEvent, KeyEventKind, poll, read};
use crossterm::terminal::{disable_raw_mode, enable_raw_mode};
use std::io::IsTerminal;
use std::time::Duration;
use trundle::app::AppError;

/// The terminal while it hands over each key at once, unseen; dropped, it is as before.
#[derive(Debug)]
pub struct RawTerminal(());

/// Refuses to go on where nobody can press a key.
pub fn require() -> Result<(), AppError> {
    if std::io::stdin().is_terminal() {
        Ok(())
    } else {
        Err(AppError::Input("--keys reads the keyboard, but standard input is no terminal".to_owned()))
    }
}

impl RawTerminal {
    /// Takes the terminal over.
    ///
    /// # Errors
    /// When it refuses.
    pub fn new() -> Result<Self, AppError> {
        enable_raw_mode().map(|()| Self(())).map_err(refused)
    }

    /// The keys pressed since the last time, without waiting.
    ///
    /// # Errors
    /// When the terminal has gone away.
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
