//! Poses and rotations.

use crate::generated::geometry_msgs::{Point, Pose, PoseStamped, PoseWithCovariance, Quaternion};
use nalgebra::{Matrix3, Quaternion as Numbers, UnitQuaternion};
use trundle_core::{Invalid, Pose2, Pose3, Stamp, Vector3, require_finite};

/// Largest deviation of a rotation's length from 1. Source: ours; single precision gives 1e-7, hand-written poses 1e-2.
const MAX_LENGTH_DEVIATION: f64 = 0.05;
/// Largest tilt of a pose on the floor \[rad\]: 15 deg. Source: ours.
const MAX_TILT_RAD: f64 = 0.26;

/// A rotation.
///
/// # Errors
/// When a number is not finite, or the length is not 1: a rotation of zeros was never set.
pub fn rotation(q: &Quaternion) -> Result<UnitQuaternion<f64>, Invalid> {
    let numbers = Numbers::new(q.w, q.x, q.y, q.z);
    let length = require_finite("length of the orientation", numbers.norm(), "")?;
    if (length - 1.0).abs() > MAX_LENGTH_DEVIATION {
        return Err(Invalid::new(
            "length of the orientation",
            length,
            "",
            "1: set x, y, z, w of the quaternion",
        ));
    }
    Ok(UnitQuaternion::from_quaternion(numbers))
}

/// A rotation as a message.
#[must_use]
pub fn quaternion(rotation: &UnitQuaternion<f64>) -> Quaternion {
    Quaternion { x: rotation.i, y: rotation.j, z: rotation.k, w: rotation.w }
}

/// A pose in space.
///
/// # Errors
/// When a number is not finite, or the rotation was never set.
pub fn pose3(pose: &Pose) -> Result<Pose3, Invalid> {
    let Point { x, y, z } = pose.position;
    for (name, value) in [("position.x", x), ("position.y", y), ("position.z", z)] {
        require_finite(name, value, "m")?;
    }
    Ok(Pose3::new(rotation(&pose.orientation)?, Vector3::new(x, y, z)))
}

/// A pose on the floor; its height is dropped.
///
/// # Errors
/// As [`pose3`], and when the pose is tilted by more than 15 deg.
pub fn pose2(pose: &Pose) -> Result<Pose2, Invalid> {
    let pose = pose3(pose)?;
    let tilt = pose.rotate(Vector3::z()).z.clamp(-1.0, 1.0).acos();
    if tilt > MAX_TILT_RAD {
        return Err(Invalid::new(
            "tilt of the pose",
            format!("{:.1}", tilt.to_degrees()),
            "deg",
            "at most 15 deg",
        ));
    }
    let ahead = pose.rotate(Vector3::x());
    Ok(Pose2::new(pose.translation.x, pose.translation.y, ahead.y.atan2(ahead.x)))
}

/// A pose on the floor as a message.
#[must_use]
pub fn to_ros(pose: &Pose2) -> Pose {
    space_to_ros(&Pose3::from_pose2(*pose))
}

/// A pose in space as a message.
#[must_use]
pub fn space_to_ros(pose: &Pose3) -> Pose {
    let position = Point { x: pose.translation.x, y: pose.translation.y, z: pose.translation.z };
    Pose { position, orientation: quaternion(&pose.rotation) }
}

/// A pose with stamp and frame.
#[must_use]
pub fn stamped(pose: &Pose2, stamp: Stamp, frame: &str) -> PoseStamped {
    PoseStamped { header: super::stamp::header(stamp, frame), pose: to_ros(pose) }
}

/// Places of x, y and turn around z in the six rows of a covariance. Source: `geometry_msgs/PoseWithCovariance`.
pub(super) const PLANAR: [usize; 3] = [0, 1, 5];

/// A pose with its covariance. `covariance` is a right perturbation, in the axes of the base; the message has the axes of the pose's
/// frame.
#[must_use]
pub fn with_covariance(pose: &Pose2, covariance: &Matrix3<f64>) -> PoseWithCovariance {
    let turn = turn_of_axes(pose.theta);
    let turned = turn * covariance * turn.transpose();
    let mut message = PoseWithCovariance { pose: to_ros(pose), ..PoseWithCovariance::default() };
    for (i, row) in PLANAR.into_iter().enumerate() {
        for (j, column) in PLANAR.into_iter().enumerate() {
            message.covariance[row * 6 + column] = turned[(i, j)];
        }
    }
    message
}

/// The covariance of x, y and theta of a message as a right perturbation.
///
/// # Errors
/// When a number is not finite or a variance is negative.
pub fn covariance(message: &[f64; 36], theta: f64) -> Result<Matrix3<f64>, Invalid> {
    let mut matrix = Matrix3::zeros();
    for (i, row) in PLANAR.into_iter().enumerate() {
        for (j, column) in PLANAR.into_iter().enumerate() {
            let value = message[row * 6 + column];
            matrix[(i, j)] = require_finite(&format!("covariance[{}]", row * 6 + column), value, "")?;
        }
        if matrix[(i, i)] < 0.0 {
            let field = format!("covariance[{}]", row * 7);
            return Err(Invalid::new(field, matrix[(i, i)], "", "0 or above"));
        }
    }
    let turn = turn_of_axes(theta);
    Ok(turn.transpose() * matrix * turn)
}

fn turn_of_axes(theta: f64) -> Matrix3<f64> {
    let (sin, cos) = theta.sin_cos();
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_and_covariances_go_there_and_back() {
        let pose = Pose2::new(1.0, -2.0, 2.5);
        let own = Matrix3::new(0.04, 0.001, 0.0, 0.001, 0.01, 0.002, 0.0, 0.002, 0.3);
        let message = with_covariance(&pose, &own);
        let back = pose2(&message.pose).unwrap();
        assert!(back.distance(&pose) < 1e-12 && (back.theta - pose.theta).abs() < 1e-12);
        assert!((covariance(&message.covariance, pose.theta).unwrap() - own).norm() < 1e-12);
    }

    #[test]
    fn rotations_that_were_never_set_and_numbers_that_are_none_are_refused() {
        let mut pose = Pose::default();
        assert!(pose2(&pose).unwrap_err().to_string().starts_with("length of the orientation is 0"));
        pose.orientation = Quaternion { x: 1.0, y: 0.0, z: 0.0, w: 0.0 };
        assert!(pose2(&pose).unwrap_err().to_string().starts_with("tilt of the pose is 180.0 deg"));
        pose.orientation = Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };
        pose.position.x = f64::NAN;
        assert!(pose2(&pose).unwrap_err().to_string().starts_with("position.x is NaN m"));
        let mut numbers = [0.0; 36];
        numbers[35] = -1.0;
        assert!(covariance(&numbers, 0.0).unwrap_err().to_string().starts_with("covariance[35] is -1"));
    }
}
