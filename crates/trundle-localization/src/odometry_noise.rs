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
