//! Detection of wheels that do not respond to commands.

use crate::odometry_noise::UnobservedMotion;
use trundle_core::Twist2;

/// Compares commanded motion with encoder counts. It distinguishes unresponsive wheels (stuck encoders, blocked wheels, motors without
/// power) from a robot at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WheelFault {
    command: Twist2,
    /// Largest speed that the base may have after the commands, m/s, not negative.
    max_v: f64,
    /// Largest turn rate that the base may have after the commands, rad/s, not negative.
    max_omega: f64,
    unanswered: Unanswered,
    is_unresponsive: bool,
}

/// Commands since the last encoder count.
#[derive(Debug, Clone, Copy, Default)]
struct Unanswered {
    /// Time with a command to roll, s.
    time: f64,
    /// Largest distance that the base may have driven, m.
    distance: f64,
    /// Largest angle that the base may have turned, rad.
    turn: f64,
}

/// Commanded speed of a wheel above which it must roll, m/s: static friction may hold slower wheels. Source: ours.
const MIN_ROLLING_SPEED_M_S: f64 = 0.04;
/// Time for a commanded wheel to roll, s. Longer without a count means that the wheels do not respond. Source: ours.
const MAX_RESPONSE_TIME_S: f64 = 0.5;
/// Smallest deceleration of a base, m/s^2: bounds the speed left after a command to stop. Source: ours.
const MIN_DECELERATION_M_S2: f64 = 0.3;
/// Smallest angular deceleration of a base, rad/s^2: bounds the turn rate left after a command to stop. Source: ours.
const MIN_ANGULAR_DECELERATION_RAD_S2: f64 = 1.5;

impl Default for WheelFault {
    fn default() -> Self {
        Self {
            command: Twist2::ZERO,
            max_v: 0.0,
            max_omega: 0.0,
            unanswered: Unanswered::default(),
            is_unresponsive: false,
        }
    }
}

impl WheelFault {
    /// Sets the twist that the base is commanded to drive.
    pub(crate) fn set_command(&mut self, twist: Twist2) {
        if twist.is_finite() {
            self.command = twist;
        }
    }

    /// Whether the wheels do not respond to commands.
    pub(crate) fn is_unresponsive(&self) -> bool {
        self.is_unresponsive
    }

    /// Whether the command must make at least one wheel roll. A base without ticks is then not at rest.
    pub(crate) fn is_commanded_to_roll(&self, half_base: f64) -> bool {
        self.command.v.abs() + self.command.omega.abs() * half_base > MIN_ROLLING_SPEED_M_S
    }

    /// Adds `dt` s in which the encoders counted (`rolled`) or did not. Returns the motion that the base may have made without counts.
    pub(crate) fn step(&mut self, half_base: f64, rolled: bool, dt: f64) -> UnobservedMotion {
        self.max_v = self.command.v.abs().max(self.max_v - MIN_DECELERATION_M_S2 * dt).max(0.0);
        self.max_omega =
            self.command.omega.abs().max(self.max_omega - MIN_ANGULAR_DECELERATION_RAD_S2 * dt).max(0.0);
        let was_unresponsive = self.is_unresponsive;
        if rolled {
            self.unanswered = Unanswered::default();
            self.is_unresponsive = false;
            return UnobservedMotion::default();
        }
        if self.is_commanded_to_roll(half_base) {
            self.unanswered.time += dt;
            self.unanswered.distance += self.max_v * dt;
            self.unanswered.turn += self.max_omega * dt;
        }
        self.is_unresponsive |= self.unanswered.time > MAX_RESPONSE_TIME_S;
        match (was_unresponsive, self.is_unresponsive) {
            (false, true) => UnobservedMotion::of_total(self.unanswered.distance, self.unanswered.turn),
            (true, _) => UnobservedMotion::of_speeds(self.max_v, self.max_omega, dt),
            (false, false) => UnobservedMotion::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_BASE: f64 = 0.115;
    const STEP: f64 = 0.02;

    fn steps(wheels: &mut WheelFault, count: usize, rolled: bool) -> (f64, f64) {
        (0..count).fold((0.0, 0.0), |sum, _| {
            let motion = wheels.step(HALF_BASE, rolled, STEP);
            (sum.0 + motion.distance_variance, sum.1 + motion.turn_variance)
        })
    }

    #[test]
    fn commanded_wheels_without_counts_are_unresponsive_until_they_count_again() {
        let mut wheels = WheelFault::default();
        assert_eq!(steps(&mut wheels, 1000, false), (0.0, 0.0), "no command");
        wheels.set_command(Twist2::new(0.3, 0.0));
        assert_eq!(steps(&mut wheels, 24, false), (0.0, 0.0), "within the response time");
        let (distance, turn) = steps(&mut wheels, 26, false);
        assert!(wheels.is_unresponsive() && turn == 0.0);
        assert!((0.3..0.6).contains(&distance.sqrt()), "0.3 m in a second: {}", distance.sqrt());
        wheels.set_command(Twist2::ZERO);
        steps(&mut wheels, 60, false);
        assert_eq!(steps(&mut wheels, 50, false), (0.0, 0.0), "the base has stopped");
        assert!(wheels.is_unresponsive(), "no counts at rest do not clear the fault");
        steps(&mut wheels, 1, true);
        assert!(!wheels.is_unresponsive());
    }

    #[test]
    fn slow_commands_and_answered_commands_are_not_a_fault() {
        let mut wheels = WheelFault::default();
        wheels.set_command(Twist2::new(0.01, 0.1));
        assert_eq!(steps(&mut wheels, 1000, false), (0.0, 0.0));
        wheels.set_command(Twist2::new(0.0, 1.0));
        for _ in 0..10 {
            assert_eq!(steps(&mut wheels, 20, false), (0.0, 0.0));
            steps(&mut wheels, 1, true);
        }
        assert!(!wheels.is_unresponsive());
        let (distance, turn) = steps(&mut wheels, 50, false);
        assert!(distance == 0.0 && (1.0..2.0).contains(&turn.sqrt()), "{turn}");
    }
}
