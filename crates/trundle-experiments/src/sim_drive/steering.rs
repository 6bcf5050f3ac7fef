//! Converts key presses to twists.

use trundle_core::Twist2;

/// Change of forward speed by one press \[m/s\]. Source: ours.
const SPEED_STEP_M_S: f64 = 0.05;
/// Change of turn rate by one press \[rad/s\]. Source: ours.
const TURN_RATE_STEP_RAD_S: f64 = 0.2;

/// Maximum number of steps forward: 0.5 m/s. Further presses have no effect. Source: ours.
const MAX_STEPS_FORWARD: i32 = 10;
/// Maximum number of steps backward: 0.3 m/s. Further presses have no effect. Source: ours.
const MAX_STEPS_BACKWARD: i32 = 6;
/// Maximum number of steps to either side: 1.4 rad/s. Further presses have no effect. Source: ours.
const MAX_STEPS_ASIDE: i32 = 7;

/// The command of the keys: each press is a step faster, slower or to a side.
#[derive(Debug, Clone, Copy, Default)]
pub struct Steering {
    ahead: i32,
    left: i32,
    has_quit: bool,
}

/// The effect of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SteeringKey {
    /// A step faster.
    Faster,
    /// A step slower, or backward.
    Slower,
    /// A step to the left.
    Left,
    /// A step to the right.
    Right,
    /// Stop.
    Stop,
    /// Stop, and end the drive.
    Quit,
}

impl Steering {
    /// Applies a key.
    pub fn press(&mut self, key: SteeringKey) {
        match key {
            SteeringKey::Faster => self.ahead += 1,
            SteeringKey::Slower => self.ahead -= 1,
            SteeringKey::Left => self.left += 1,
            SteeringKey::Right => self.left -= 1,
            SteeringKey::Stop => (self.ahead, self.left) = (0, 0),
            SteeringKey::Quit => *self = Self { has_quit: true, ..Self::default() },
        }
        self.ahead = self.ahead.clamp(-MAX_STEPS_BACKWARD, MAX_STEPS_FORWARD);
        self.left = self.left.clamp(-MAX_STEPS_ASIDE, MAX_STEPS_ASIDE);
    }

    /// The commanded twist.
    #[must_use]
    pub fn twist(&self) -> Twist2 {
        Twist2::new(f64::from(self.ahead) * SPEED_STEP_M_S, f64::from(self.left) * TURN_RATE_STEP_RAD_S)
    }

    /// Whether the drive is over.
    #[must_use]
    pub fn has_quit(&self) -> bool {
        self.has_quit
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use SteeringKey::{Faster, Left, Quit, Right, Slower, Stop};

    fn after(keys: &[SteeringKey]) -> Steering {
        let mut steering = Steering::default();
        keys.iter().for_each(|&key| steering.press(key));
        steering
    }

    #[test]
    fn presses_add_up_to_a_limit_and_stop_ends_the_motion() {
        let twist = after(&[Faster, Faster, Left, Left]).twist();
        assert!((twist.v - 0.1).abs() < 1e-12 && (twist.omega - 0.4).abs() < 1e-12, "{twist:?}");
        assert_eq!(after(&[Right, Right, Left, Left]).twist(), Twist2::ZERO);
        assert!((after(&[Faster; 99]).twist().v - 0.5).abs() < 1e-12);
        assert!((after(&[Slower; 99]).twist().v + 0.3).abs() < 1e-12);
        assert_eq!(after(&[Faster, Left, Stop]).twist(), Twist2::ZERO);
    }

    #[test]
    fn quitting_stops() {
        let quit = after(&[Faster, Quit]);
        assert!(quit.has_quit() && quit.twist() == Twist2::ZERO);
        assert!(!after(&[Stop]).has_quit());
    }
}
