//! Driving by the commands of viewers.

use trundle_core::{Stamp, Twist2};
use trundle_runtime::{OperatorCommand, TELEOP_SILENCE_S};

/// The last twist of the viewers. Without a new twist for [`TELEOP_SILENCE_S`] the robot stops.
#[derive(Debug, Default)]
pub struct Teleop {
    wanted: Option<(Twist2, Stamp)>,
}

impl Teleop {
    /// Obeys a command at `now`: a twist drives, all others stop.
    pub fn execute(&mut self, command: &OperatorCommand, now: Stamp) {
        self.wanted = match command {
            OperatorCommand::Drive(twist) => Some((*twist, now)),
            _ => None,
        };
    }

    /// The twist at `now`.
    #[must_use]
    pub fn twist(&self, now: Stamp) -> Twist2 {
        let fresh = self.wanted.filter(|(_, since)| now - *since <= TELEOP_SILENCE_S);
        fresh.map_or(Twist2::ZERO, |(twist, _)| twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twist_holds_until_silence_or_another_command() {
        let (mut teleop, twist) = (Teleop::default(), Twist2::new(0.2, 0.1));
        let at = |seconds: f64| Stamp::default().after(seconds);
        assert_eq!(teleop.twist(at(0.0)), Twist2::ZERO);
        teleop.execute(&OperatorCommand::Drive(twist), at(1.0));
        assert_eq!((teleop.twist(at(1.29)), teleop.twist(at(1.31))), (twist, Twist2::ZERO));
        teleop.execute(&OperatorCommand::Drive(twist), at(2.0));
        teleop.execute(&OperatorCommand::Pause, at(2.0));
        assert_eq!(teleop.twist(at(2.0)), Twist2::ZERO);
    }
}
