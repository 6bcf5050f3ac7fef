//! Keys to twists.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use trundle::core::Twist2;

/// Change of forward speed by one press \[m/s\]. Source: ours.
const SPEED_STEP_M_S: f64 = 0.05;
/// Change of turn rate by one press \[rad/s\]. Source: ours.
const TURN_RATE_STEP_RAD_S: f64 = 0.2;

/// Steps forward: 0.5 m/s. Further presses change nothing. Source: ours.
const MAX_STEPS_FORWARD: i32 = 10;
/// Steps backward: 0.3 m/s. Further presses change nothing. Source: ours.
const MAX_STEPS_BACKWARD: i32 = 6;
/// Steps to either side: 1.4 rad/s. Further presses change nothing. Source: ours.
const MAX_STEPS_ASIDE: i32 = 7;

/// The command of the keys: each press is a step faster, slower or to a side.
#[derive(Debug, Clone, Copy, Default)]
pub struct Steering {
    ahead: i32,
    left: i32,
    has_quit: bool,
}

impl Steering {
    /// Applies a key; other keys change nothing.
    pub fn press(&mut self, key: KeyEvent) {
        let is_control = key.modifiers.contains(KeyModifiers::CONTROL);
        match key.code {
            KeyCode::Char('c' | 'd') if is_control => self.quit(),
            KeyCode::Char('q' | 'Q') | KeyCode::Esc => self.quit(),
            KeyCode::Up | KeyCode::Char('w' | 'W') => self.ahead += 1,
            KeyCode::Down | KeyCode::Char('s' | 'S') => self.ahead -= 1,
            KeyCode::Left | KeyCode::Char('a' | 'A') => self.left += 1,
            KeyCode::Right | KeyCode::Char('d' | 'D') => self.left -= 1,
            KeyCode::Char(' ') => (self.ahead, self.left) = (0, 0),
            _ => {}
        }
        self.ahead = self.ahead.clamp(-MAX_STEPS_BACKWARD, MAX_STEPS_FORWARD);
        self.left = self.left.clamp(-MAX_STEPS_ASIDE, MAX_STEPS_ASIDE);
    }

    /// The commanded twist.
    pub fn twist(&self) -> Twist2 {
        Twist2::new(f64::from(self.ahead) * SPEED_STEP_M_S, f64::from(self.left) * TURN_RATE_STEP_RAD_S)
    }

    /// Whether `q`, Esc or Ctrl-C was pressed.
    pub fn has_quit(&self) -> bool {
        self.has_quit
    }

    fn quit(&mut self) {
        *self = Self { has_quit: true, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(keys: &[KeyCode]) -> Steering {
        let mut steering = Steering::default();
        keys.iter().for_each(|&key| steering.press(KeyEvent::new(key, KeyModifiers::NONE)));
        steering
    }

    #[test]
    fn presses_add_up_to_a_limit_and_space_stops() {
        let twist = after(&[KeyCode::Up, KeyCode::Char('w'), KeyCode::Left, KeyCode::Char('A')]).twist();
        assert!((twist.v - 0.1).abs() < 1e-12 && (twist.omega - 0.4).abs() < 1e-12, "{twist:?}");
        let twist = after(&[KeyCode::Char('d'), KeyCode::Right, KeyCode::Left, KeyCode::Left]).twist();
        assert_eq!(twist, Twist2::ZERO);
        assert!((after(&[KeyCode::Up; 99]).twist().v - 0.5).abs() < 1e-12);
        assert!((after(&[KeyCode::Down; 99]).twist().v + 0.3).abs() < 1e-12);
        assert_eq!(after(&[KeyCode::Up, KeyCode::Left, KeyCode::Char(' ')]).twist(), Twist2::ZERO);
    }

    #[test]
    fn quitting_stops() {
        let quit = after(&[KeyCode::Up, KeyCode::Char('q')]);
        assert!(quit.has_quit() && quit.twist() == Twist2::ZERO);
        let mut steering = after(&[KeyCode::Char('c'), KeyCode::Char('z')]);
        assert!(!steering.has_quit());
        steering.press(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL));
        assert!(steering.has_quit());
    }
}
