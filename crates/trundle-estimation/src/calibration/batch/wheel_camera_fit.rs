//! Wheels, wheelbase and the camera's place on the base from one drive.
//!
//! Problem: the wheels' radii r_L and r_R, the wheelbase b, and the camera's offset m and yaw a on the base. The data are the turns of the
//! wheels and the camera's trajectory. Idea \[Censi13\]: the turn of a segment is linear in J_L = -r_L / b and J_R = r_R / b. Given these,
//! the camera's displacement is linear in (b cos a, -b sin a, R(-a) m). Both are linear least-squares problems without initial values.
//! Cost: O(segments).
//!
//! | \[Censi13\] | here | unit |
//! |---|---|---|
//! | J_21, J_22 | `turn.x` | |
//! | b | `wheelbase` | m |
//! | l_x, l_y, l_theta | `offset_x`, `offset_y`, `yaw` | m, m, rad |
//! | s_x, s_y | `Segment::displacement` | m |

use super::error::CalibrationError;
use super::estimate::Estimate;
use super::linear_fit::{LinearFit, LinearSolution};
use super::planar_track::planar_track;
use super::segments::{Segment, segments};
use super::wheel_angles::{WheelAngles, WheelTurn};
use nalgebra::{Matrix2x4, Vector2, Vector4};
use trundle_core::{DifferentialDrive, Hypotenuse, Pose3, Stamp, Vector3};

/// Wheels and mount of the camera, estimated from one drive. A number that the drive does not determine equals the number in use, with the
/// standard deviation of the prior.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelCameraFit {
    /// Radius of the left wheel, m.
    pub left_radius: Estimate,
    /// Radius of the right wheel, m.
    pub right_radius: Estimate,
    /// Mean of both radii, m.
    pub mean_radius: Estimate,
    /// Distance between the wheels, m.
    pub wheelbase: Estimate,
    /// Camera forward of the base's origin, m.
    pub offset_x: Estimate,
    /// Camera left of the base's origin, m.
    pub offset_y: Estimate,
    /// Turn of the camera to the left, rad.
    pub yaw: Estimate,
    /// Noise of a segment's turn, rad.
    pub turn_residual: f64,
    /// Noise of a segment's displacement, m.
    pub displacement_residual: f64,
    /// Number of segments.
    pub segments: usize,
}

/// Smallest number of segments: 8, about 3 m or a full turn. Source: ours.
const MIN_SEGMENTS: usize = 8;
/// Prior standard deviation of radii and wheelbase, ratio. Source: ours; the error of a value is at most a third.
const DRIVE_PRIOR_RATIO: f64 = 0.3;
/// Standard deviation of the difference of both radii, ratio: 0.01. It determines the result if the robot only turns on the spot. Source:
/// ours, three times the unequal diameters of \[Borenstein96\].
const RADIUS_DIFFERENCE_RATIO: f64 = 0.01;
/// Prior standard deviation of the camera's offset: 1 m. Source: ours, half of the range of a mount.
const OFFSET_PRIOR_M: f64 = 1.0;
/// Smallest noise of a segment's turn: 0.5 mrad. Source: ours.
const MIN_TURN_SIGMA_RAD: f64 = 5e-4;
/// Smallest noise of a segment's displacement: 0.5 mm. Source: ours.
const MIN_DISPLACEMENT_SIGMA_M: f64 = 5e-4;

/// Fits wheels and mount to the camera's poses (`visual_from_camera`, by rising stamp, on the wheels' clock). `up` is the upward axis
/// in the camera's frame; `drive` is the drive in use, a weak prior.
///
/// # Errors
/// When too few segments contain motion.
pub fn fit_wheels_and_camera(
    poses: &[(Stamp, Pose3)],
    up: Vector3,
    wheels: &WheelAngles,
    drive: &DifferentialDrive,
) -> Result<WheelCameraFit, CalibrationError> {
    let segments = segments(&planar_track(poses, up), wheels);
    let too_few = || CalibrationError::TooFewReadings {
        sensor: "segments with motion of camera and wheels",
        found: segments.len(),
        expected: MIN_SEGMENTS,
        advice: "drive 3 m or more and turn on the spot by a full turn both ways, in view of walls with texture",
    };
    if segments.len() < MIN_SEGMENTS {
        return Err(too_few());
    }
    let turn = fit_turn(&segments, drive).ok_or_else(too_few)?;
    let shift = fit_displacement(&segments, drive, &turn.x).ok_or_else(too_few)?;
    Ok(WheelCameraFit { segments: segments.len(), ..assembled(&turn, &shift) })
}

/// Step 1: (J_L, J_R) of `turn = J_L left + J_R right`.
fn fit_turn(segments: &[Segment], drive: &DifferentialDrive) -> Option<LinearSolution<2>> {
    let mut fit = LinearFit::new(MIN_TURN_SIGMA_RAD);
    for segment in segments {
        fit.add(Vector2::new(segment.wheels.left, segment.wheels.right), segment.turn);
    }
    let ratio = drive.wheel_radius / drive.wheelbase;
    fit.add_prior(Vector2::x(), -ratio, DRIVE_PRIOR_RATIO * ratio);
    fit.add_prior(Vector2::y(), ratio, DRIVE_PRIOR_RATIO * ratio);
    fit.add_prior(Vector2::new(1.0, 1.0), 0.0, RADIUS_DIFFERENCE_RATIO * ratio);
    fit.solve()
}

/// Step 2: (b cos a, -b sin a, R(-a) m) of the displacement.
fn fit_displacement(
    segments: &[Segment],
    drive: &DifferentialDrive,
    turn: &Vector2<f64>,
) -> Option<LinearSolution<4>> {
    let mut fit = LinearFit::new(MIN_DISPLACEMENT_SIGMA_M);
    // Forward distance over the wheelbase.
    let distance = |wheels: &WheelTurn| (turn.y * wheels.right - turn.x * wheels.left) / 2.0;
    for segment in segments {
        let d = segment.base_displacement(distance);
        let (sin, cos) = segment.turn.sin_cos();
        fit.add(Vector4::new(d.x, -d.y, cos - 1.0, -sin), segment.displacement.x);
        fit.add(Vector4::new(d.y, d.x, sin, cos - 1.0), segment.displacement.y);
    }
    let prior = DRIVE_PRIOR_RATIO * drive.wheelbase;
    fit.add_prior(Vector4::x(), drive.wheelbase, prior);
    fit.add_prior(Vector4::y(), 0.0, prior);
    fit.add_prior(Vector4::z(), 0.0, OFFSET_PRIOR_M);
    fit.add_prior(Vector4::w(), 0.0, OFFSET_PRIOR_M);
    fit.solve()
}

/// Physical numbers from both linear solutions; covariances to first order.
fn assembled(turn: &LinearSolution<2>, shift: &LinearSolution<4>) -> WheelCameraFit {
    let (p, q) = (shift.x[0], shift.x[1]);
    let (wheelbase, yaw) = (p.hypotenuse(q), (-q).atan2(p));
    let along = Vector4::new(p, q, 0.0, 0.0) / wheelbase;
    let across = Vector4::new(q, -p, 0.0, 0.0) / (wheelbase * wheelbase);
    let base_variance = along.dot(&(shift.covariance * along));
    let radius = |gain: Vector2<f64>| {
        let ratio = gain.dot(&turn.x);
        let variance =
            gain.dot(&(turn.covariance * gain)) * wheelbase * wheelbase + ratio * ratio * base_variance;
        Estimate::new(ratio * wheelbase, variance.sqrt())
    };
    let (offset, offset_covariance) = offset(shift, yaw, &across);
    WheelCameraFit {
        left_radius: radius(Vector2::new(-1.0, 0.0)),
        right_radius: radius(Vector2::new(0.0, 1.0)),
        mean_radius: radius(Vector2::new(-0.5, 0.5)),
        wheelbase: Estimate::new(wheelbase, base_variance.sqrt()),
        offset_x: Estimate::new(offset.x, offset_covariance.x.sqrt()),
        offset_y: Estimate::new(offset.y, offset_covariance.y.sqrt()),
        yaw: Estimate::new(yaw, across.dot(&(shift.covariance * across)).sqrt()),
        turn_residual: turn.sigma,
        displacement_residual: shift.sigma,
        segments: 0,
    }
}

/// The camera's offset on the base, `m = R(a) R(-a) m`, and its variances, with the gradient of the yaw.
fn offset(shift: &LinearSolution<4>, yaw: f64, yaw_gradient: &Vector4<f64>) -> (Vector2<f64>, Vector2<f64>) {
    let turned = nalgebra::Rotation2::new(yaw);
    let offset = turned * Vector2::new(shift.x[2], shift.x[3]);
    let mut jacobian = Matrix2x4::zeros();
    jacobian.fixed_view_mut::<2, 2>(0, 2).copy_from(turned.matrix());
    jacobian += Vector2::new(-offset.y, offset.x) * yaw_gradient.transpose();
    let covariance = jacobian * shift.covariance * jacobian.transpose();
    (offset, covariance.diagonal())
}
