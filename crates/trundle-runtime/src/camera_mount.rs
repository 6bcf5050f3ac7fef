//! The camera's pose on the robot.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, Vector3, require_in};

/// Pose of the camera on the base; angles are in degrees in a robot file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraMount {
    /// Position of the camera forward of the base's origin, m, -2 to 2. Default 0.05: over the Kobuki's front deck.
    pub x: f64,
    /// Position of the camera left of the base's origin, m, -2 to 2. Default 0: on the middle line of the robot.
    pub y: f64,
    /// Height of the camera above the floor, m, 0 to 3. Default 0.45 (ours): a Kobuki with its camera is 0.6 m high.
    pub z: f64,
    /// Turn of the camera to the left, deg, -180 to 180. Default 0: straight ahead.
    pub yaw_deg: f64,
    /// Tilt of the camera downward, deg, -80 to 80. A larger tilt shows nearer floor, and less of the walls. Default 8: the floor is
    /// visible from 0.6 m on.
    pub pitch_deg: f64,
    /// Roll of the camera around the optical axis, deg, -180 to 180. Default 0: level.
    pub roll_deg: f64,
}

impl Default for CameraMount {
    fn default() -> Self {
        Self { x: 0.05, y: 0.0, z: 0.45, yaw_deg: 0.0, pitch_deg: 8.0, roll_deg: 0.0 }
    }
}

/// The optical frame (x right, y down, z ahead) in the camera's body frame (x ahead, y left, z up). Source: REP 103.
const BODY_FROM_OPTICAL: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);

impl CameraMount {
    /// Returns a valid mount unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("mount.x", self.x, "m", -2.0, 2.0)?;
        require_in("mount.y", self.y, "m", -2.0, 2.0)?;
        require_in("mount.z", self.z, "m", 0.0, 3.0)?;
        require_in("mount.yaw_deg", self.yaw_deg, "deg", -180.0, 180.0)?;
        require_in("mount.pitch_deg", self.pitch_deg, "deg", -80.0, 80.0)?;
        require_in("mount.roll_deg", self.roll_deg, "deg", -180.0, 180.0)?;
        Ok(self)
    }

    /// The mount whose [`CameraMount::base_from_camera`] is `base_from_camera`.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn of_pose(base_from_camera: &Pose3) -> Result<Self, Invalid> {
        let turn = base_from_camera.rotation_matrix() * BODY_FROM_OPTICAL.transpose();
        let (roll, pitch, yaw) = nalgebra::Rotation3::from_matrix_unchecked(turn).euler_angles();
        let [x, y, z] = base_from_camera.translation.into();
        let [yaw_deg, pitch_deg, roll_deg] = [yaw, pitch, roll].map(f64::to_degrees);
        Self { x, y, z, yaw_deg, pitch_deg, roll_deg }.validated()
    }

    /// `base_from_camera`, the camera in its optical frame.
    pub fn base_from_camera(&self) -> Pose3 {
        let turn = nalgebra::Rotation3::from_euler_angles(
            self.roll_deg.to_radians(),
            self.pitch_deg.to_radians(),
            self.yaw_deg.to_radians(),
        );
        Pose3::from_matrix(turn.into_inner() * BODY_FROM_OPTICAL, Vector3::new(self.x, self.y, self.z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_camera_looks_forward_and_down() {
        let mount = CameraMount { pitch_deg: 30.0, ..CameraMount::default() };
        let optical_axis = mount.base_from_camera().rotate(Vector3::z());
        assert!((optical_axis - Vector3::new(0.75_f64.sqrt(), 0.0, -0.5)).norm() < 1e-12);
        let right = mount.base_from_camera().rotate(Vector3::x());
        assert!((right + Vector3::y()).norm() < 1e-12);
    }

    #[test]
    fn a_mount_comes_back_from_its_pose() {
        let mount = CameraMount { x: 0.1, y: -0.2, z: 0.3, yaw_deg: 40.0, pitch_deg: 8.0, roll_deg: -3.0 };
        let back = CameraMount::of_pose(&mount.base_from_camera()).unwrap();
        for (a, b) in [
            (back.x, mount.x),
            (back.z, mount.z),
            (back.yaw_deg, mount.yaw_deg),
            (back.pitch_deg, mount.pitch_deg),
            (back.roll_deg, mount.roll_deg),
        ] {
            assert!((a - b).abs() < 1e-9, "{back:?}");
        }
        assert!(CameraMount::of_pose(&Pose3::identity()).is_err(), "it looks up");
    }

    #[test]
    fn each_number_is_checked_by_name() {
        let field = |mount: CameraMount| mount.validated().unwrap_err().field;
        let good = CameraMount::default();
        assert_eq!(good.validated(), Ok(good));
        for (mount, name) in [
            (CameraMount { x: 3.0, ..good }, "mount.x"),
            (CameraMount { y: -3.0, ..good }, "mount.y"),
            (CameraMount { z: -0.1, ..good }, "mount.z"),
            (CameraMount { yaw_deg: 200.0, ..good }, "mount.yaw_deg"),
            (CameraMount { pitch_deg: 90.0, ..good }, "mount.pitch_deg"),
            (CameraMount { roll_deg: f64::NAN, ..good }, "mount.roll_deg"),
        ] {
            assert_eq!(field(mount), name);
        }
    }

    #[test]
    fn a_camera_that_is_turned_left_looks_left() {
        let mount = CameraMount { yaw_deg: 90.0, pitch_deg: 0.0, ..CameraMount::default() };
        let optical_axis = mount.base_from_camera().rotate(Vector3::z());
        assert!((optical_axis - Vector3::y()).norm() < 1e-12, "{optical_axis}");
        let at = mount.base_from_camera().translation;
        assert_eq!((at.x, at.y, at.z), (mount.x, mount.y, mount.z));
    }
}
