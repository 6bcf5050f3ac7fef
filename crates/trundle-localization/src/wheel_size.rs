use crate::{OdometryConfig, learnt::Learnt};
use trundle_core::{Pose2, Vector3};

/// How large the wheels are over their nominal radius, learnt while driving: two Kalman filters of one number.
///
/// Their mean comes of chords that the camera saw, over the odometry's of the same time; their difference of straight ways on
/// which wheels and gyro turn by different angles, `turn = 2 e way / wheelbase`.
#[derive(Debug, Clone)]
pub(crate) struct WheelSize {
    mean: Learnt,
    difference: Learnt,
    seen: Option<Seen>,
    stretch: Stretch,
}

/// Where a chord began.
#[derive(Debug, Clone, Copy)]
struct Seen {
    odom_from_base: Pose2,
    at: Vector3,
}

/// What the wheels did since the last measurement of their difference.
#[derive(Debug, Clone, Copy, Default)]
struct Stretch {
    way: f64,
    /// Of the gyro's turn, rad^2.
    variance: f64,
    by_gyro: f64,
    /// Turn by the gyro less turn by the wheels, rad.
    apart: f64,
}

/// A small motion by wheels and gyro: m, rad.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rolled {
    pub(crate) way: f64,
    pub(crate) by_wheels: f64,
    /// The turn by the gyro and its variance, rad^2.
    pub(crate) by_gyro: Option<(f64, f64)>,
}

/// Chords and straight stretches at least so long are measured, m.
const LEAST_WAY: f64 = 1.0;
/// A stretch that turns by more is not straight, rad: an error of the wheelbase would count for one of the wheels.
const STRAIGHT: f64 = 0.2;
/// Noise of the length of a chord that the camera saw (one sigma): m, and as a part of it.
const CHORD_NOISE: (f64, f64) = (0.006, 0.005);
/// What an uneven floor turns the robot by that its wheels do not show, rad / sqrt(m).
const FLOOR_NOISE: f64 = 0.005;

impl WheelSize {
    pub(crate) fn new(config: &OdometryConfig) -> Self {
        Self {
            mean: Learnt::new(1.0, config.wheel_radius_sigma),
            difference: Learnt::new(0.0, config.wheel_radius_sigma),
            seen: None,
            stretch: Stretch::default(),
        }
    }

    /// True over nominal radius of the left wheel and of the right one.
    pub(crate) fn ratios(&self) -> (f64, f64) {
        (
            self.mean.value() * (1.0 - self.difference.value()),
            self.mean.value() * (1.0 + self.difference.value()),
        )
    }

    /// What came before does not belong to what comes: a gap, or a slip.
    pub(crate) fn interrupt(&mut self) {
        self.seen = None;
        self.stretch = Stretch::default();
    }

    /// What the camera saw before does not belong to what it will see.
    pub(crate) fn unseen(&mut self) {
        self.seen = None;
    }

    /// The robot rolled on.
    pub(crate) fn rolled(&mut self, wheelbase: f64, step: Rolled) {
        let Some((by_gyro, variance)) = step.by_gyro else {
            self.stretch = Stretch::default();
            return;
        };
        self.stretch.way += step.way;
        self.stretch.variance += variance;
        self.stretch.by_gyro += by_gyro;
        self.stretch.apart += by_gyro - step.by_wheels;
        let is_straight = self.stretch.by_gyro.abs() < STRAIGHT;
        if is_straight && self.stretch.way.abs() < LEAST_WAY {
            return;
        }
        let Stretch { way, variance, apart, .. } = std::mem::take(&mut self.stretch);
        if is_straight {
            let lever = wheelbase / (2.0 * way);
            let turn = variance + FLOOR_NOISE.powi(2) * way.abs();
            self.difference.learn(self.difference.value() + apart * lever, turn * lever * lever);
        }
    }

    /// The camera saw the robot at `at` when the odometry had it at `odom_from_base`.
    pub(crate) fn seen(&mut self, odom_from_base: Pose2, at: Vector3) {
        let now = Seen { odom_from_base, at };
        let Some(from) = self.seen else {
            self.seen = Some(now);
            return;
        };
        let rolled = (odom_from_base.position() - from.odom_from_base.position()).norm();
        if rolled < LEAST_WAY {
            return;
        }
        let chord = (at - from.at).norm();
        let sigma = CHORD_NOISE.0.hypot(CHORD_NOISE.1 * chord) / rolled;
        self.mean.learn(self.mean.value() * chord / rolled, sigma * sigma);
        self.seen = Some(now);
    }
}
