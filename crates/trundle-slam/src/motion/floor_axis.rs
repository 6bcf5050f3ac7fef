//! The axis around which a camera on a floor turns, from its motion priors.

use trundle_core::{Pose3, Vector3};

/// Smallest rotation of a prior that determines its axis: 1e-3 rad. A smaller one is skipped. Source: ours.
const MIN_TURN_RAD: f64 = 1e-3;
/// Largest component of a prior off the floor's plane: 1e-6, m of translation and rad of rotation. Beyond it the camera is not on a
/// floor. Source: ours, the rounding of planar odometry.
const MAX_OFF_PLANE: f64 = 1e-6;

/// Axis of rotation that all motion priors share: wheels on a floor turn around one axis and translate perpendicular to it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct FloorAxis {
    /// The axis, camera frame, unit length, up or down.
    axis: Option<Vector3>,
    /// Whether a prior left the plane.
    is_off_plane: bool,
}

impl FloorAxis {
    /// Records a motion prior.
    pub fn record(&mut self, prior: Pose3) {
        let turn = prior.rotation.scaled_axis();
        let own = turn.try_normalize(MIN_TURN_RAD);
        let axis = *self.axis.get_or_insert_with(|| own.unwrap_or_else(Vector3::zeros));
        self.is_off_plane |=
            turn.cross(&axis).norm() > MAX_OFF_PLANE || prior.translation.dot(&axis).abs() > MAX_OFF_PLANE;
        self.axis = self.axis.filter(|axis| *axis != Vector3::zeros());
    }

    /// The axis around which the camera turns, camera frame; the earlier axis `before` until a prior turns. `None` if the camera is not on
    /// a floor.
    pub fn axis_after(&self, before: Option<Vector3>) -> Option<Vector3> {
        self.axis.or(before).filter(|_| !self.is_off_plane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{camera_along_floor, camera_on_floor};
    use nalgebra::Vector6;
    use trundle_core::Pose2;

    #[test]
    fn planar_priors_determine_the_axis_and_priors_of_a_hand_do_not() {
        let mut floor = FloorAxis::default();
        floor.record(
            camera_on_floor().inverse() * Pose3::from_pose2(Pose2::new(0.1, 0.0, 0.0)) * camera_on_floor(),
        );
        assert_eq!(floor.axis_after(None), None);
        assert_eq!(floor.axis_after(Some(Vector3::y())), Some(Vector3::y()), "it has not turned yet");
        (1..20).for_each(|i| floor.record(camera_along_floor(i - 1).inverse() * camera_along_floor(i)));
        let axis = floor.axis_after(None).unwrap();
        assert!(camera_on_floor().rotate(axis).z.abs() > 1.0 - 1e-9);
        floor.record(Pose3::exp(Vector6::new(0.0, 0.0, 0.01, 0.001, 0.002, 0.003)));
        assert_eq!(floor.axis_after(Some(Vector3::y())), None);
    }
}
