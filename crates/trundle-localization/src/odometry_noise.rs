use crate::OdometryConfig;
use nalgebra::Matrix3;
use std::f64::consts::PI;

/// One small motion of the base, and how it was measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    /// Forward, m.
    pub(crate) way: f64,
    /// Counter-clockwise, rad.
    pub(crate) turn: f64,
    /// Seconds.
    pub(crate) dt: f64,
    /// The variance of the turn where it is the gyro's, rad^2.
    pub(crate) by_gyro: Option<f64>,
    /// Metres that the wheels' rims and the gyro disagree by, when they slip; else 0.
    pub(crate) slip: f64,
}

/// The covariance of a step as a right perturbation.
pub(crate) fn of_step(config: &OdometryConfig, step: &Step) -> Matrix3<f64> {
    let (way, turn) = (step.way.abs(), step.turn.abs());
    let slip = config.slip_length * step.slip;
    // A slip of the wheels that nobody checks is part of these two constants.
    let by_wheels = config.wheel_turn_noise.powi(2) * turn + config.wheel_way_noise.powi(2) * way;
    let heading = step.by_gyro.unwrap_or(by_wheels);
    let spot = config.spot_noise.powi(2) * turn + slip;
    Matrix3::from_diagonal(&nalgebra::Vector3::new(
        config.way_noise.powi(2) * way + spot,
        config.sideways_noise.powi(2) * way + spot,
        heading,
    ))
}

/// The covariance of an unknown motion of `gap` s.
pub(crate) fn of_gap(config: &OdometryConfig, gap: f64) -> Matrix3<f64> {
    /// Turn for each metre that the robot may have gone, rad.
    const TURN: f64 = 3.0;
    /// However long the gap: m. More would drown the steps after it, whose noise is a difference of such numbers.
    const FARTHEST: f64 = 10.0;
    let way = (config.gap_speed * gap).min(FARTHEST).powi(2);
    let turn = (TURN * TURN * way).min(PI * PI);
    Matrix3::from_diagonal(&nalgebra::Vector3::new(way, way, turn))
}

/// What the base may have done that nobody counted: variances of its way, m^2, and of its turn, rad^2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Untold {
    pub(crate) way_variance: f64,
    pub(crate) turn_variance: f64,
}

/// For so long what is not counted is not counted the same way, s.
const UNTOLD_LASTS: f64 = 2.0;
/// Of a way that nobody counted so much may be sideways: it bends.
const SIDEWAYS: f64 = 0.2;

impl Untold {
    /// So much way and turn (m, rad).
    pub(crate) fn at_once(way: f64, turn: f64) -> Self {
        Self { way_variance: way * way, turn_variance: turn * turn }
    }

    /// `dt` s of so many m/s and rad/s.
    pub(crate) fn on_and_on(pace: (f64, f64), dt: f64) -> Self {
        let grown = |speed: f64| speed * speed * UNTOLD_LASTS * dt;
        Self { way_variance: grown(pace.0), turn_variance: grown(pace.1) }
    }

    /// As a right perturbation (x m, y m, theta rad); a turn that the gyro told was told.
    pub(crate) fn covariance(&self, has_gyro: bool) -> Matrix3<f64> {
        let turn = if has_gyro { 0.0 } else { self.turn_variance };
        let sideways = SIDEWAYS * SIDEWAYS * self.way_variance;
        Matrix3::from_diagonal(&nalgebra::Vector3::new(self.way_variance, sideways, turn))
    }
}
