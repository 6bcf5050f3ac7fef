//! The simulated base of the control tests.

use std::collections::VecDeque;
use trundle_core::{DifferentialDrive, Pose2, PoseEstimate, Stamp, Twist2};

/// The control period, s.
pub const DT: f64 = 0.02;
const STEP: f64 = 0.002;

/// A Kobuki: commands arrive late, wheels ramp and lag, noise comes from a fixed generator.
pub struct Plant {
    pub pose: Pose2,
    pub now: Stamp,
    /// Delay from a command to its effect, s.
    pub delay: f64,
    /// Time constant of the motors, s.
    pub lag: f64,
    /// Maximum acceleration of a wheel, m/s^2.
    pub ramp: f64,
    /// Half width of the estimate's uniform noise: m, rad.
    pub noise: (f64, f64),
    speed: [f64; 2],
    set: [f64; 2],
    pending: VecDeque<(i64, Twist2)>,
    target: Twist2,
    rng_state: u64,
}

impl Plant {
    pub fn at(pose: Pose2) -> Self {
        Self {
            pose,
            now: Stamp::default(),
            delay: 0.03,
            lag: 0.05,
            ramp: 1.2,
            noise: (0.0, 0.0),
            speed: [0.0; 2],
            set: [0.0; 2],
            pending: VecDeque::new(),
            target: Twist2::ZERO,
            rng_state: 0x9E37_79B9_7F4A_7C15,
        }
    }

    /// A plant that already moves.
    pub fn moving(mut self, twist: Twist2) -> Self {
        let (left, right) = DifferentialDrive::KOBUKI.wheel_speeds(twist);
        self.speed = [left, right];
        self.set = self.speed;
        self.target = twist;
        self
    }

    pub fn twist(&self) -> Twist2 {
        DifferentialDrive::KOBUKI.twist(self.speed[0], self.speed[1])
    }

    /// Estimate of localization.
    pub fn estimate(&mut self) -> PoseEstimate {
        let (p, a) = self.noise;
        let noisy = Pose2::new(
            self.pose.x + p * self.draw(),
            self.pose.y + p * self.draw(),
            self.pose.theta + a * self.draw(),
        );
        PoseEstimate {
            stamp: self.now,
            pose: noisy,
            twist: self.twist(),
            covariance: nalgebra::Matrix3::zeros(),
        }
    }

    /// Sends a command and simulates one control period.
    pub fn drive(&mut self, command: Twist2) {
        self.pending.push_back((self.now.after(self.delay).nanos, command));
        let mut passed = 0.0;
        while passed < DT - 1e-9 {
            while self.pending.front().is_some_and(|(due, _)| *due <= self.now.nanos) {
                self.target = self.pending.pop_front().unwrap().1;
            }
            let (left, right) = DifferentialDrive::KOBUKI.wheel_speeds(self.target);
            for (i, rim) in [left, right].into_iter().enumerate() {
                self.set[i] += (rim - self.set[i]).clamp(-self.ramp * STEP, self.ramp * STEP);
                self.speed[i] += (self.set[i] - self.speed[i]) * (1.0 - (-STEP / self.lag).exp());
            }
            self.pose = self.pose.advance(self.twist(), STEP);
            self.now = self.now.after(STEP);
            passed += STEP;
        }
    }

    /// Uniform in -1..1 (xorshift: the same in every run).
    fn draw(&mut self) -> f64 {
        self.rng_state ^= self.rng_state << 13;
        self.rng_state ^= self.rng_state >> 7;
        self.rng_state ^= self.rng_state << 17;
        (self.rng_state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
