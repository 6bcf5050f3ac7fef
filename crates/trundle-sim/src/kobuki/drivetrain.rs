//! The drivetrain: wheel speeds from commanded twists, with delay, saturation, ramp and lag.

use super::config::KobukiConfig;
use super::dynamics_step::{STEP_S, STEPS_PER_SECOND};
use std::collections::VecDeque;
use trundle_core::{DifferentialDrive, Twist2};

/// From commanded twists to speeds of the wheels' circumferences: delay, saturation, ramp, lag.
#[derive(Debug)]
pub(super) struct Drivetrain {
    drive: DifferentialDrive,
    wheel_speed: f64,
    /// Largest change of a wheel's set speed in a step, m/s.
    ramp: f64,
    /// Part of the gap to the set speed that the motor closes in a step.
    closing: f64,
    delay_steps: u64,
    /// Steps without a command after which the base stops; `None` is never.
    timeout_steps: Option<u64>,
    /// Time at which the last command took effect.
    heard: u64,
    now: u64,
    /// Commands within the delay: (step at which they take effect, wheel speeds).
    pending: VecDeque<(u64, [f64; 2])>,
    target: [f64; 2],
    set: [f64; 2],
    speed: [f64; 2],
}

impl Drivetrain {
    pub(super) fn new(config: &KobukiConfig) -> Self {
        Self {
            drive: config.drive,
            wheel_speed: config.wheel_speed,
            ramp: config.wheel_acceleration * STEP_S,
            closing: if config.motor_lag > 0.0 { 1.0 - (-STEP_S / config.motor_lag).exp() } else { 1.0 },
            delay_steps: steps(config.command_delay),
            timeout_steps: (config.command_timeout > 0.0).then(|| steps(config.command_timeout)),
            heard: 0,
            now: 0,
            pending: VecDeque::new(),
            target: [0.0; 2],
            set: [0.0; 2],
            speed: [0.0; 2],
        }
    }

    /// Takes a finite command; it takes effect after the delay.
    pub(super) fn command(&mut self, twist: Twist2) {
        let (left, right) = self.drive.wheel_speeds(twist);
        let excess = (left.abs().max(right.abs()) / self.wheel_speed).max(1.0);
        self.pending.push_back((self.now + self.delay_steps, [left / excess, right / excess]));
    }

    /// Advances by a step; wheel speeds (left, right), m/s, of wheels of nominal radius.
    pub(super) fn step(&mut self) -> (f64, f64) {
        while self.pending.front().is_some_and(|(due, _)| *due <= self.now) {
            if let Some((due, target)) = self.pending.pop_front() {
                (self.heard, self.target) = (due, target);
            }
        }
        if self.timeout_steps.is_some_and(|max| self.now - self.heard >= max) {
            self.target = [0.0; 2];
        }
        self.now += 1;
        for side in 0..2 {
            self.set[side] += (self.target[side] - self.set[side]).clamp(-self.ramp, self.ramp);
            self.speed[side] += (self.set[side] - self.speed[side]) * self.closing;
            if self.set[side] == 0.0 && self.speed[side].abs() < 1e-6 {
                self.speed[side] = 0.0;
            }
        }
        (self.speed[0], self.speed[1])
    }
}

fn steps(seconds: f64) -> u64 {
    (seconds * STEPS_PER_SECOND).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(twist: Twist2, steps: usize) -> Vec<(f64, f64)> {
        run_as(&KobukiConfig::default(), twist, steps)
    }

    fn run_as(config: &KobukiConfig, twist: Twist2, steps: usize) -> Vec<(f64, f64)> {
        let mut drivetrain = Drivetrain::new(config);
        drivetrain.command(twist);
        (0..steps).map(|_| drivetrain.step()).collect()
    }

    #[test]
    fn a_command_waits_ramps_lags_and_arrives() {
        let speeds = run(Twist2::new(0.3, 0.0), 2000);
        assert_eq!(speeds[19], (0.0, 0.0));
        assert!(speeds[21].0 > 0.0);
        let steepest = speeds.windows(2).map(|w| w[1].0 - w[0].0).fold(0.0, f64::max);
        assert!(steepest <= 1.2e-3 + 1e-12);
        // On a ramp a first-order lag has a delay of its time constant.
        assert!((speeds[19 + 200].0 - 1.2 * (0.2 - 0.05)).abs() < 0.01, "{}", speeds[219].0);
        assert!((speeds[1999].0 - 0.3).abs() < 1e-9);
    }

    #[test]
    fn too_fast_a_command_keeps_its_curve() {
        let (left, right) = run(Twist2::new(2.0, 4.0), 3000)[2999];
        let twist = DifferentialDrive::KOBUKI.twist(left, right);
        assert!((right - 0.70).abs() < 1e-9 && (twist.omega / twist.v - 2.0).abs() < 1e-9);
    }

    #[test]
    fn the_lags_step_response_is_an_exponential() {
        let lag = 0.08;
        let config = KobukiConfig {
            motor_lag: lag,
            command_delay: 0.037,
            wheel_acceleration: 100.0,
            ..KobukiConfig::default()
        };
        // 0.1 m/s is one step's ramp: from then on the lag alone acts.
        let speeds = run_as(&config, Twist2::new(0.1, 0.0), 600);
        for (i, (left, right)) in speeds.iter().enumerate() {
            let since = (i as f64 + 1.0) * STEP_S - 0.037;
            let expected = if since > 0.0 { 0.1 * (1.0 - (-since / lag).exp()) } else { 0.0 };
            assert!((left - expected).abs() < 1e-12 && left == right, "{left} {expected} at {i}");
        }
    }

    #[test]
    fn a_delay_is_kept_to_the_millisecond() {
        for delay in [0, 1, 20, 137] {
            let config = KobukiConfig {
                motor_lag: 0.0,
                command_delay: f64::from(delay) * 1e-3,
                ..KobukiConfig::default()
            };
            let speeds = run_as(&config, Twist2::new(0.2, 0.0), 200);
            assert_eq!(speeds.iter().position(|s| s.0 > 0.0), Some(delay as usize));
        }
    }

    #[test]
    fn without_lag_speed_is_a_ramp_of_the_configured_slope() {
        let config = KobukiConfig {
            motor_lag: 0.0,
            command_delay: 0.0,
            wheel_acceleration: 0.8,
            ..KobukiConfig::default()
        };
        for (i, (left, _)) in run_as(&config, Twist2::new(0.5, 0.0), 1000).into_iter().enumerate() {
            assert!((left - (0.8 * (i as f64 + 1.0) * STEP_S).min(0.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn without_commands_it_stops_when_it_shall() {
        let config = KobukiConfig { command_timeout: 0.6, motor_lag: 0.0, ..KobukiConfig::default() };
        let speeds = run_as(&config, Twist2::new(0.3, 0.0), 2000);
        // The command takes effect at 20 ms, times out at 620 ms, and ramps down within 250 ms.
        assert_eq!((speeds[619].0, speeds[870].0), (0.3, 0.0));
        assert!(speeds[620].0 < 0.3);
        assert!(run(Twist2::new(0.3, 0.0), 3000)[2999].0 > 0.299, "by default it never does");
    }
}
