//! The plane in which a camera on wheels moves.

use crate::ids::KeyframeId;
use crate::map::keyframe::Keyframe;
use crate::map::landmark_map::LandmarkMap;
use crate::median::median;
use nalgebra::{Matrix3, Matrix6, UnitQuaternion};
use trundle_core::{Pose3, Vector3};
use trundle_optim::PoseConstraint;

/// Standard deviation of a camera's height on wheels: 0.01 m. Source: \[DIN18202, table 3\], 1 cm over 4 m.
const HEIGHT_SIGMA_M: f64 = 0.01;
/// Standard deviation of a camera's tilt on wheels: 0.004 rad. Source: \[DIN18202, table 3\], 4 mm over 1 m.
const TILT_SIGMA_RAD: f64 = 0.004;
/// Largest distance of a keyframe from the plane: 0.1 m. Beyond it the keyframe is on a ramp or on another floor, and is not
/// constrained. Source: ours.
const MAX_OFF_PLANE_M: f64 = 0.1;
/// Largest tilt of a keyframe against the plane: 0.1 rad. Source: as [`MAX_OFF_PLANE_M`].
const MAX_TILT_RAD: f64 = 0.1;
/// Fraction of the keyframes that must be on the plane: 0.8. With fewer the map has no plane. Source: ours.
const MIN_ON_PLANE_RATIO: f64 = 0.8;

/// The plane in which the camera moves, visual frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FloorPlane {
    /// Normal of the plane, camera frame.
    axis: Vector3,
    /// Normal of the plane, visual frame.
    normal: Vector3,
    /// Coordinate of the plane along its normal, m.
    height: f64,
}

impl FloorPlane {
    /// The plane of most keyframes of a map whose camera turns around `axis` (camera frame); `None` if there is none.
    pub fn of(map: &LandmarkMap, axis: Vector3) -> Option<Self> {
        let normals: Vec<Vector3> = map.keyframes().map(|(_, k)| k.visual_from_camera.rotate(axis)).collect();
        let middle = |i: usize| median(normals.iter().map(|n| n[i]));
        let normal = Vector3::new(middle(0)?, middle(1)?, middle(2)?).try_normalize(0.5)?;
        let heights = map.keyframes().map(|(_, k)| normal.dot(&k.visual_from_camera.translation));
        let plane = Self { axis, normal, height: median(heights)? };
        let on_it = map.keyframes().filter(|(_, k)| plane.has(k)).count();
        (on_it as f64 >= MIN_ON_PLANE_RATIO * normals.len() as f64).then_some(plane)
    }

    /// Constraint of a keyframe (pose index `to`) to its projection onto the plane; pose index `world` is the identity. `None` for a
    /// keyframe off the plane.
    pub fn constraint(
        &self,
        map: &LandmarkMap,
        id: KeyframeId,
        world: usize,
        to: usize,
    ) -> Option<PoseConstraint> {
        let keyframe = map.live_keyframe(id).filter(|keyframe| self.has(keyframe))?;
        let pose = keyframe.visual_from_camera;
        let upright = UnitQuaternion::rotation_between(&pose.rotate(self.axis), &self.normal)?;
        let down = self.normal * (self.height - self.normal.dot(&pose.translation));
        let from_to = Pose3::new(upright * pose.rotation, pose.translation + down);
        let across = self.axis * self.axis.transpose();
        let mut information = Matrix6::zeros();
        information.fixed_view_mut::<3, 3>(0, 0).copy_from(&(across / HEIGHT_SIGMA_M.powi(2)));
        information
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&((Matrix3::identity() - across) / TILT_SIGMA_RAD.powi(2)));
        Some(PoseConstraint { from: world, to, from_to, information })
    }

    fn has(&self, keyframe: &Keyframe) -> bool {
        let pose = keyframe.visual_from_camera;
        let off = self.normal.dot(&pose.translation) - self.height;
        off.abs() <= MAX_OFF_PLANE_M && pose.rotate(self.axis).angle(&self.normal) <= MAX_TILT_RAD
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{blank_frame, camera_along_floor, camera_on_floor};
    use nalgebra::Vector6;

    #[test]
    fn keyframes_are_constrained_to_the_common_plane_unless_they_are_off_it() {
        let mut map = LandmarkMap::default();
        let bent = Pose3::exp(Vector6::new(0.01, -0.02, 0.02, 0.01, 0.02, 0.01));
        let ids: Vec<KeyframeId> = (0..10)
            .map(|i| {
                map.add_keyframe(
                    blank_frame(1),
                    if i == 4 { camera_along_floor(i) * bent } else { camera_along_floor(i) },
                )
            })
            .collect();
        let axis = camera_on_floor().inverse().rotate(Vector3::z());
        let plane = FloorPlane::of(&map, axis).unwrap();
        let tie = plane.constraint(&map, ids[4], 7, 4).unwrap();
        assert!((tie.from_to.translation.z - camera_on_floor().translation.z).abs() < 1e-9);
        assert!(tie.from_to.rotate(axis).angle(&Vector3::z()) < 1e-9);
        let along = |pose: Pose3| pose.translation.xy();
        assert!(
            (along(tie.from_to) - along(camera_along_floor(4) * bent)).norm() < 1e-9,
            "it is free to go along the floor"
        );
        map.move_keyframe(
            ids[5],
            Pose3::exp(Vector6::new(0.0, 0.0, 0.5, 0.0, 0.0, 0.0)) * camera_along_floor(5),
        );
        assert_eq!(FloorPlane::of(&map, axis).unwrap().constraint(&map, ids[5], 7, 5), None);
        (0..5).for_each(|i| {
            map.move_keyframe(
                ids[i],
                Pose3::exp(Vector6::new(0.0, 0.0, i as f64, 0.0, 0.0, 0.0)) * camera_along_floor(i),
            );
        });
        assert_eq!(FloorPlane::of(&map, axis), None, "stairs");
    }
}
