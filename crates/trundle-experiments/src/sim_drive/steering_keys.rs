//! Keys of the terminal.

use super::steering::SteeringKey;
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

/// The effect of a key; `None` for any other key.
pub fn steering_key(key: KeyEvent) -> Option<SteeringKey> {
    let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
    Some(match key.code {
        KeyCode::Char('c' | 'd') if is_control => SteeringKey::Quit,
        KeyCode::Char('q' | 'Q') | KeyCode::Esc => SteeringKey::Quit,
        KeyCode::Up | KeyCode::Char('w' | 'W') => SteeringKey::Faster,
        KeyCode::Down | KeyCode::Char('s' | 'S') => SteeringKey::Slower,
        KeyCode::Left | KeyCode::Char('a' | 'A') => SteeringKey::Left,
        KeyCode::Right | KeyCode::Char('d' | 'D') => SteeringKey::Right,
        KeyCode::Char(' ') => SteeringKey::Stop,
        _ => return None,
    })
}
