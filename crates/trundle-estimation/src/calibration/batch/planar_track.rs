//! The camera's trajectory seen from above.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use trundle_core::{Pose3, Stamp, Vector2, Vector3, wrap_angle};

/// The camera seen from above: position and heading of the levelled camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlanarPose {
    pub(super) stamp: Stamp,
    /// Position in a fixed level frame, m.
    pub(super) position: Vector2,
    /// Heading of the levelled camera, rad, not wrapped.
    pub(super) heading: f64,
}

/// Pitch and roll of a camera whose upward axis is `up` (camera frame, unit vector): rad, as in a robot file's mount.
pub(super) fn tilt_of(up: Vector3) -> (f64, f64) {
    // up = B^T Rx(-roll) Ry(-pitch) z, with B the body axes from the optical ones.
    let body = body_from_optical() * up;
    ((-body.x).clamp(-1.0, 1.0).asin(), body.y.atan2(body.z))
}

/// `level_from_camera`: the rotation of a camera with this upward axis and heading 0.
pub(super) fn level_from_camera(up: Vector3) -> Matrix3<f64> {
    let (pitch, roll) = tilt_of(up);
    Rotation3::from_euler_angles(roll, pitch, 0.0).into_inner() * body_from_optical()
}

/// Axes of the body (x forward, y left, z up) from optical axes (x right, y down, z forward).
fn body_from_optical() -> Matrix3<f64> {
    Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0)
}

/// The poses (`visual_from_camera`, by rising stamp) of a camera with this upward axis, seen from above.
pub(super) fn planar_track(poses: &[(Stamp, Pose3)], up: Vector3) -> Vec<PlanarPose> {
    let mean_up: Vector3 = poses.iter().map(|(_, pose)| pose.rotate(up)).sum();
    let level_from_visual = UnitQuaternion::rotation_between(&mean_up, &Vector3::z()).unwrap_or_default();
    let camera_from_level = level_from_camera(up).transpose();
    let mut track: Vec<PlanarPose> = Vec::with_capacity(poses.len());
    for &(stamp, pose) in poses {
        let rotation =
            (level_from_visual * pose.rotation).to_rotation_matrix().into_inner() * camera_from_level;
        let wrapped = rotation[(1, 0)].atan2(rotation[(0, 0)]);
        let heading = track.last().map_or(wrapped, |last| last.heading + wrap_angle(wrapped - last.heading));
        let position = (level_from_visual * pose.translation).xy();
        track.push(PlanarPose { stamp, position, heading });
    }
    track
}
