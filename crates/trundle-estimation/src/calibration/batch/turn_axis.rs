//! The axis around which a camera on wheels turns.

use super::error::CalibrationError;
use nalgebra::{Matrix3, SymmetricEigen};
use trundle_core::{Pose3, Stamp, Vector3};

/// Smallest turn that determines the axis: 1 rad. Below it the noise of the camera's rotations tilts the axis. Source: ours.
const MIN_TURN_RAD: f64 = 1.0;

/// Rotation vector from one pose to the next, in the frame of the earlier camera, rad.
fn rotation(earlier: &Pose3, later: &Pose3) -> Vector3 {
    (earlier.rotation.inverse() * later.rotation).scaled_axis()
}

/// The vertical axis in the camera's frame, a unit vector upward: the main axis of the rotations between the poses
/// (`visual_from_camera`, by rising stamp). `expected` is the upward axis by the mount in use; it decides the sign.
///
/// # Errors
/// When the camera's heading changes by less than 1 rad.
pub fn turn_axis(poses: &[(Stamp, Pose3)], expected: Vector3) -> Result<Vector3, CalibrationError> {
    let turned = turned_range(poses, expected);
    if turned < MIN_TURN_RAD {
        return Err(not_turned(turned));
    }
    let steps = poses.windows(2).map(|pair| rotation(&pair[0].1, &pair[1].1));
    let eigen = SymmetricEigen::new(steps.map(|step| step * step.transpose()).sum::<Matrix3<f64>>());
    let axis: Vector3 = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into();
    Ok(if axis.dot(&expected) < 0.0 { -axis } else { axis })
}

/// Difference of the largest and the smallest heading around `axis`, rad; noise does not accumulate in this measure.
fn turned_range(poses: &[(Stamp, Pose3)], axis: Vector3) -> f64 {
    let (mut heading, mut low, mut high) = (0.0, 0.0_f64, 0.0_f64);
    for turn in turns(poses, axis) {
        heading += turn.angle;
        (low, high) = (low.min(heading), high.max(heading));
    }
    high - low
}

fn not_turned(turned: f64) -> CalibrationError {
    CalibrationError::NotObservable {
        what: "the turn of the camera",
        quantity: "the range of its heading",
        found: turned,
        unit: "rad",
        expected: format!("{MIN_TURN_RAD} rad or more"),
        advice: "turn the robot on the spot by a full turn in each direction",
    }
}

/// Turns around `axis` (camera frame) from each pose to the next: stamps of both poses, and the turn \[rad\].
pub(super) fn turns(poses: &[(Stamp, Pose3)], axis: Vector3) -> impl Iterator<Item = Turn> + '_ {
    poses.windows(2).map(move |pair| Turn {
        from: pair[0].0,
        to: pair[1].0,
        angle: rotation(&pair[0].1, &pair[1].1).dot(&axis),
    })
}

/// A turn between two images.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub(super) from: Stamp,
    pub(super) to: Stamp,
    /// Counter-clockwise, rad.
    pub(super) angle: f64,
}
