//! Online calibration of the wheels' radii.

use crate::{calibration::scalar_kalman::ScalarKalman, odometry_config::OdometryConfig};
use trundle_core::{Hypotenuse, Pose2, Vector3};

/// Ratio of the wheels' true to nominal radii, estimated during the drive by two scalar Kalman filters.
///
/// The mean ratio is measured by chords of the camera's path, divided by the odometry's chord of the same time. The difference is measured
/// on straight segments where wheels and gyro turn by different angles: `turn = 2 e distance / wheelbase`.
#[derive(Debug, Clone)]
pub(crate) struct WheelCalibration {
    mean: ScalarKalman,
    difference: ScalarKalman,
    chord_start: Option<ChordStart>,
    segment: StraightSegment,
}

/// Start of a chord, by odometry and camera.
#[derive(Debug, Clone, Copy)]
struct ChordStart {
    odom_from_base: Pose2,
    visual_position: Vector3,
}

/// Motion since the last measurement of the wheels' difference.
#[derive(Debug, Clone, Copy, Default)]
struct StraightSegment {
    /// Distance, m.
    distance: f64,
    /// Variance of the gyro's turn, rad^2.
    variance: f64,
    /// Turn by the gyro, rad.
    by_gyro: f64,
    /// Turn by the gyro minus turn by the wheels, rad.
    difference: f64,
}

/// A small motion by wheels and gyro.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WheelStep {
    /// Distance forward, m.
    pub(crate) distance: f64,
    /// Turn by the wheels, rad.
    pub(crate) by_wheels: f64,
    /// Turn by the gyro, rad, and its variance, rad^2.
    pub(crate) by_gyro: Option<(f64, f64)>,
}

/// Smallest length of chords and straight segments, m. Shorter ones determine the radii poorly. Source: ours.
const MIN_DISTANCE_M: f64 = 1.0;
/// Largest turn of a straight segment, rad. In a larger turn, an error of the wheelbase would appear as one of the radii. Source: ours.
const MAX_STRAIGHT_TURN_RAD: f64 = 0.2;
/// Noise of the camera's chord (one sigma), m. Source: ours.
const CHORD_SIGMA_M: f64 = 0.006;
/// Noise of the camera's chord per metre (one sigma), ratio. Source: ours.
const CHORD_SIGMA_RATIO: f64 = 0.005;
/// Turn by an uneven floor that the wheels do not measure, rad / sqrt(m) (one sigma). Source: ours.
const FLOOR_TURN_SIGMA: f64 = 0.005;

impl WheelCalibration {
    pub(crate) fn new(config: &OdometryConfig) -> Self {
        Self {
            mean: ScalarKalman::new(1.0, config.wheel_radius_sigma),
            difference: ScalarKalman::new(0.0, config.wheel_radius_sigma),
            chord_start: None,
            segment: StraightSegment::default(),
        }
    }

    /// True over nominal radius of the left wheel and of the right one.
    pub(crate) fn ratios(&self) -> (f64, f64) {
        (
            self.mean.value() * (1.0 - self.difference.value()),
            self.mean.value() * (1.0 + self.difference.value()),
        )
    }

    /// Ends chord and segment: after a gap or a slip.
    pub(crate) fn interrupt(&mut self) {
        self.chord_start = None;
        self.segment = StraightSegment::default();
    }

    /// Ends the chord: the next visual position is in another frame.
    pub(crate) fn break_visual_track(&mut self) {
        self.chord_start = None;
    }

    /// Adds a motion by wheels and gyro.
    pub(crate) fn add_step(&mut self, wheelbase: f64, step: WheelStep) {
        let Some((by_gyro, variance)) = step.by_gyro else {
            self.segment = StraightSegment::default();
            return;
        };
        self.segment.distance += step.distance;
        self.segment.variance += variance;
        self.segment.by_gyro += by_gyro;
        self.segment.difference += by_gyro - step.by_wheels;
        let is_straight = self.segment.by_gyro.abs() < MAX_STRAIGHT_TURN_RAD;
        if is_straight && self.segment.distance.abs() < MIN_DISTANCE_M {
            return;
        }
        let StraightSegment { distance, variance, difference, .. } = std::mem::take(&mut self.segment);
        if is_straight {
            let lever = wheelbase / (2.0 * distance);
            let turn = variance + FLOOR_TURN_SIGMA.powi(2) * distance.abs();
            self.difference.update(self.difference.value() + difference * lever, turn * lever * lever);
        }
    }

    /// Adds a position of the base by the camera, with the odometry's pose at the same stamp.
    pub(crate) fn add_visual_position(&mut self, odom_from_base: Pose2, visual_position: Vector3) {
        let end = ChordStart { odom_from_base, visual_position };
        let Some(start) = self.chord_start else {
            self.chord_start = Some(end);
            return;
        };
        let by_odometry = (odom_from_base.position() - start.odom_from_base.position()).norm();
        if by_odometry < MIN_DISTANCE_M {
            return;
        }
        let by_camera = (visual_position - start.visual_position).norm();
        let sigma = CHORD_SIGMA_M.hypotenuse(CHORD_SIGMA_RATIO * by_camera) / by_odometry;
        self.mean.update(self.mean.value() * by_camera / by_odometry, sigma * sigma);
        self.chord_start = Some(end);
    }
}
