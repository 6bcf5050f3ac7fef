//! Motion between two keyframes by wheels and gyro, with its first-order dependence on their calibration.

use super::state::{BIAS_PLACE, BORDER_SIZE, BorderState, CHAIN_SIZE, SCALE_PLACE, WHEELS_PLACE};
use crate::odometry::motion_increment::MotionIncrement;
use crate::odometry_config::OdometryConfig;
use crate::odometry_noise::{Step, of_step};
use crate::planar::{right_jacobian, symmetric};
use nalgebra::{Matrix3, RowSVector, SMatrix, SVector, Vector3};
use trundle_core::Pose2;

/// Number of calibration parameters: bias, scale, left radius, right radius, wheelbase. Source: ours, the number of the named parameters.
const PARAMETER_COUNT: usize = 5;
const PARAMETER_BIAS: usize = 0;
const PARAMETER_SCALE: usize = 1;
const PARAMETER_LEFT: usize = 2;
const PARAMETER_RIGHT: usize = 3;
const PARAMETER_WHEELBASE: usize = 4;

/// Values of the calibration parameters.
pub(crate) type Parameters = SVector<f64, PARAMETER_COUNT>;

/// The parameters of a keyframe.
pub(crate) fn parameters(bias: f64, border: &BorderState) -> Parameters {
    let [left, right, wheelbase] = border.wheels.data.0[0];
    Parameters::from([bias, border.scale, left, right, wheelbase])
}

/// Spreads derivatives by the parameters over the unknowns of keyframe and border.
pub(crate) fn spread<const R: usize>(
    by_parameters: &SMatrix<f64, R, PARAMETER_COUNT>,
) -> (SMatrix<f64, R, CHAIN_SIZE>, SMatrix<f64, R, BORDER_SIZE>) {
    let (mut chain, mut border) =
        (SMatrix::<f64, R, CHAIN_SIZE>::zeros(), SMatrix::<f64, R, BORDER_SIZE>::zeros());
    chain.set_column(BIAS_PLACE, &by_parameters.column(PARAMETER_BIAS));
    border.set_column(SCALE_PLACE, &by_parameters.column(PARAMETER_SCALE));
    for k in 0..3 {
        border.set_column(WHEELS_PLACE + k, &by_parameters.column(PARAMETER_LEFT + k));
    }
    (chain, border)
}

/// Motion of several increments (Forster et al. 2017, for wheels and one gyro axis in the plane).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Preintegrated {
    /// Parameters of the integration.
    pub(crate) at: Parameters,
    /// Motion of the base.
    pub(crate) motion: Pose2,
    /// Derivative by the parameters, as a right perturbation.
    pub(crate) by_parameters: SMatrix<f64, 3, PARAMETER_COUNT>,
    /// Covariance as a right perturbation.
    pub(crate) covariance: Matrix3<f64>,
    /// Turn by the wheels, in addition to that of the gyro.
    pub(crate) wheels: WheelTurn,
    /// Time at rest and the gyro's turn during that time.
    pub(crate) rest: GyroAtRest,
    /// Duration, s.
    pub(crate) duration: f64,
    /// Length of the path, m.
    pub(crate) distance: f64,
    /// Sum of all absolute turns, rad.
    pub(crate) turned: f64,
}

/// Turn by the wheels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WheelTurn {
    /// \[rad\].
    pub(crate) turn: f64,
    /// Derivative by the parameters.
    pub(crate) by_parameters: RowSVector<f64, PARAMETER_COUNT>,
    /// Variance without slip, rad^2.
    variance: f64,
    /// Absolute turn by slip, rad.
    slip: f64,
    /// Whether both gyro and wheels measured all turns and can be compared.
    is_second: bool,
}

/// The gyro of a robot at rest.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GyroAtRest {
    /// Number of readings.
    pub(crate) readings: f64,
    /// Time, s.
    pub(crate) time: f64,
    /// Turn by the gyro, with its bias, rad.
    pub(crate) turn: f64,
}

/// Smallest sigma of a motion between two keyframes, m and rad: rounding and a soft floor. Source: ours.
const MIN_SIGMA: f64 = 1e-4;

impl Preintegrated {
    /// No motion, for these parameters.
    pub(crate) fn new(at: Parameters) -> Self {
        Self {
            at,
            motion: Pose2::IDENTITY,
            by_parameters: SMatrix::zeros(),
            covariance: Matrix3::zeros(),
            wheels: WheelTurn {
                turn: 0.0,
                by_parameters: RowSVector::zeros(),
                variance: 0.0,
                slip: 0.0,
                is_second: true,
            },
            rest: GyroAtRest::default(),
            duration: 0.0,
            distance: 0.0,
            turned: 0.0,
        }
    }

    /// Appends a fraction (0 to 1) of an increment; `wheelbase` is the nominal one, m.
    pub(crate) fn add(&mut self, config: &OdometryConfig, wheelbase: f64, part: &MotionIncrement) {
        let at = &self.at;
        let distance = (at[PARAMETER_LEFT] * part.left + at[PARAMETER_RIGHT] * part.right) / 2.0;
        let (by_wheels, by_wheels_by) = turn_by_wheels(at, wheelbase, part);
        let (turn, turn_by) = match part.turn_by_gyro {
            _ if part.is_at_rest => (0.0, RowSVector::zeros()),
            Some(measured) => turn_by_gyro(at, measured, part.dt),
            None => (by_wheels, by_wheels_by),
        };
        let mut tangent_by = SMatrix::<f64, 3, PARAMETER_COUNT>::zeros();
        tangent_by[(0, PARAMETER_LEFT)] = part.left / 2.0;
        tangent_by[(0, PARAMETER_RIGHT)] = part.right / 2.0;
        tangent_by.set_row(2, &turn_by);
        let tangent = Vector3::new(distance, 0.0, turn);
        let step = Pose2::exp(tangent);
        let back = step.inverse().adjoint();
        self.motion = self.motion * step;
        self.by_parameters = back * self.by_parameters + right_jacobian(&tangent) * tangent_by;
        let own = of_step(config, &step_of(config, part, distance, turn)) + part.unobserved;
        self.covariance = symmetric(back * self.covariance * back.transpose()) + own;
        self.wheels.add(config, wheelbase, part, by_wheels, &by_wheels_by);
        self.note(part, distance, turn);
    }

    fn note(&mut self, part: &MotionIncrement, distance: f64, turn: f64) {
        self.duration += part.dt;
        self.distance += distance.abs();
        self.turned += turn.abs();
        if let Some(turn) = part.turn_by_gyro.filter(|_| part.is_at_rest) {
            self.rest.readings += 1.0;
            self.rest.time += part.dt;
            self.rest.turn += turn;
        }
    }

    /// The motion for other parameters, to first order.
    pub(crate) fn corrected(&self, parameters: &Parameters) -> Pose2 {
        self.motion * Pose2::exp(self.by_parameters * (parameters - self.at))
    }

    /// Covariance of the motion, positive definite.
    pub(crate) fn noise(&self) -> Matrix3<f64> {
        self.covariance + Matrix3::identity() * (MIN_SIGMA * MIN_SIGMA)
    }
}

impl WheelTurn {
    fn add(
        &mut self,
        config: &OdometryConfig,
        wheelbase: f64,
        part: &MotionIncrement,
        turn: f64,
        by: &RowSVector<f64, PARAMETER_COUNT>,
    ) {
        self.turn += turn;
        self.by_parameters += by;
        let distance = (part.left + part.right).abs() / 2.0;
        self.variance +=
            config.wheel_turn_noise.powi(2) * turn.abs() + config.wheel_distance_noise.powi(2) * distance;
        self.slip += 2.0 * part.slip / wheelbase;
        self.is_second &= part.turn_by_gyro.is_some() && part.unobserved == Matrix3::zeros();
    }

    /// The turn's variance if wheels and gyro can be compared, rad^2.
    pub(crate) fn comparison_variance(&self) -> Option<f64> {
        self.is_second.then_some(self.variance + self.slip * self.slip + MIN_SIGMA * MIN_SIGMA)
    }
}

fn turn_by_wheels(
    at: &Parameters,
    wheelbase: f64,
    part: &MotionIncrement,
) -> (f64, RowSVector<f64, PARAMETER_COUNT>) {
    let base = wheelbase * at[PARAMETER_WHEELBASE];
    let turn = (at[PARAMETER_RIGHT] * part.right - at[PARAMETER_LEFT] * part.left) / base;
    let mut by = RowSVector::zeros();
    by[PARAMETER_LEFT] = -part.left / base;
    by[PARAMETER_RIGHT] = part.right / base;
    by[PARAMETER_WHEELBASE] = -turn / at[PARAMETER_WHEELBASE];
    (turn, by)
}

fn turn_by_gyro(at: &Parameters, measured: f64, dt: f64) -> (f64, RowSVector<f64, PARAMETER_COUNT>) {
    let turn = measured - at[PARAMETER_BIAS] * dt;
    let mut by = RowSVector::zeros();
    by[PARAMETER_BIAS] = -at[PARAMETER_SCALE] * dt;
    by[PARAMETER_SCALE] = turn;
    (turn * at[PARAMETER_SCALE], by)
}

fn step_of(config: &OdometryConfig, part: &MotionIncrement, distance: f64, turn: f64) -> Step {
    let by_gyro = part.turn_by_gyro.map(|_| match part.is_at_rest {
        true => 0.0,
        false => config.gyro_turn_noise.powi(2) * turn.abs() + config.gyro_time_noise.powi(2) * part.dt,
    });
    Step { distance, turn, dt: part.dt, by_gyro, slip: part.slip }
}
