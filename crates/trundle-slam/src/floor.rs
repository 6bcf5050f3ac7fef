use crate::ids::KeyframeId;
use crate::map::{Keyframe, LandmarkMap};
use crate::median::median;
use nalgebra::{Matrix3, Matrix6, UnitQuaternion};
use trundle_core::{Pose3, Vector3};
use trundle_optim::PoseConstraint;

/// How far from the plane a camera on wheels may be, m, and how much it may lean against it, rad: a floor may be off by 1 cm over
/// 4 m and 4 mm over 1 m \[DIN18202, table 3\].
const SIGMA: (f64, f64) = (0.01, 0.004);
/// What is farther off than this, m and rad, is on a ramp or on another floor.
const ELSEWHERE: (f64, f64) = (0.1, 0.1);
/// Part of the keyframes that must be on the plane for it to be one.
const MOST: f64 = 0.8;
/// A smaller turn, rad, does not tell its axis.
const LEAST_TURN: f64 = 1e-3;
/// How exactly a prior that comes from wheels on a floor keeps to the plane: m and rad.
const EXACT: f64 = 1e-6;

/// What the motion priors say of a floor: those of wheels all turn about one axis and go across it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Floor {
    /// The axis, camera frame, unit length, up or down.
    axis: Option<Vector3>,
    /// A prior did not keep to it.
    is_left: bool,
}

impl Floor {
    /// Takes a motion prior.
    pub fn note(&mut self, prior: Pose3) {
        let turn = prior.rotation.scaled_axis();
        let own = turn.try_normalize(LEAST_TURN);
        let axis = *self.axis.get_or_insert_with(|| own.unwrap_or_else(Vector3::zeros));
        self.is_left |= turn.cross(&axis).norm() > EXACT || prior.translation.dot(&axis).abs() > EXACT;
        self.axis = self.axis.filter(|axis| *axis != Vector3::zeros());
    }

    /// The axis about which the camera turns, camera frame; as long as it has not turned the one known `before`. `None` where the
    /// camera is not on a floor.
    pub fn axis_after(&self, before: Option<Vector3>) -> Option<Vector3> {
        self.axis.or(before).filter(|_| !self.is_left)
    }
}

/// The plane in which the camera moves, visual frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Plane {
    /// Across the plane, camera frame.
    axis: Vector3,
    /// The same in the visual frame.
    normal: Vector3,
    /// Along it, m.
    height: f64,
}

impl Plane {
    /// The plane of most keyframes of a map whose camera turns about `axis` (camera frame); `None` where there is none.
    pub fn of(map: &LandmarkMap, axis: Vector3) -> Option<Self> {
        let normals: Vec<Vector3> = map.keyframes().map(|(_, k)| k.visual_from_camera.rotate(axis)).collect();
        let middle = |i: usize| median(normals.iter().map(|n| n[i]));
        let normal = Vector3::new(middle(0)?, middle(1)?, middle(2)?).try_normalize(0.5)?;
        let heights = map.keyframes().map(|(_, k)| normal.dot(&k.visual_from_camera.translation));
        let plane = Self { axis, normal, height: median(heights)? };
        let on_it = map.keyframes().filter(|(_, k)| plane.has(k)).count();
        (on_it as f64 >= MOST * normals.len() as f64).then_some(plane)
    }

    /// Ties the keyframe, which is pose `to`, to where it would be on the plane; pose `world` is the identity. `None` of one that is elsewhere.
    pub fn tie(&self, map: &LandmarkMap, id: KeyframeId, world: usize, to: usize) -> Option<PoseConstraint> {
        let keyframe = map.live_keyframe(id).filter(|keyframe| self.has(keyframe))?;
        let pose = keyframe.visual_from_camera;
        let upright = UnitQuaternion::rotation_between(&pose.rotate(self.axis), &self.normal)?;
        let down = self.normal * (self.height - self.normal.dot(&pose.translation));
        let from_to = Pose3::new(upright * pose.rotation, pose.translation + down);
        let across = self.axis * self.axis.transpose();
        let mut information = Matrix6::zeros();
        information.fixed_view_mut::<3, 3>(0, 0).copy_from(&(across / SIGMA.0.powi(2)));
        information
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&((Matrix3::identity() - across) / SIGMA.1.powi(2)));
        Some(PoseConstraint { from: world, to, from_to, information })
    }

    fn has(&self, keyframe: &Keyframe) -> bool {
        let pose = keyframe.visual_from_camera;
        let off = self.normal.dot(&pose.translation) - self.height;
        off.abs() <= ELSEWHERE.0 && pose.rotate(self.axis).angle(&self.normal) <= ELSEWHERE.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blank_frame;
    use nalgebra::Vector6;
    use trundle_core::Pose2;

    /// A camera 0.4 m above the floor, turned and tilted on its robot.
    fn mount() -> Pose3 {
        Pose3::exp(Vector6::new(0.1, 0.02, 0.4, -1.4, 1.1, -1.2))
    }

    fn at(i: usize) -> Pose3 {
        let along = 0.2 * i as f64;
        Pose3::from_pose2(Pose2::new(along.sin(), 0.5 * along, 0.3 * along)) * mount()
    }

    #[test]
    fn priors_of_wheels_tell_the_floor_and_those_of_a_hand_do_not() {
        let mut floor = Floor::default();
        floor.note(mount().inverse() * Pose3::from_pose2(Pose2::new(0.1, 0.0, 0.0)) * mount());
        assert_eq!(floor.axis_after(None), None);
        assert_eq!(floor.axis_after(Some(Vector3::y())), Some(Vector3::y()), "it has not turned yet");
        (1..20).for_each(|i| floor.note(at(i - 1).inverse() * at(i)));
        let axis = floor.axis_after(None).unwrap();
        assert!(mount().rotate(axis).z.abs() > 1.0 - 1e-9);
        floor.note(Pose3::exp(Vector6::new(0.0, 0.0, 0.01, 0.001, 0.002, 0.003)));
        assert_eq!(floor.axis_after(Some(Vector3::y())), None);
    }

    #[test]
    fn a_keyframe_is_tied_to_the_plane_of_most_but_not_one_elsewhere() {
        let mut map = LandmarkMap::default();
        let bent = Pose3::exp(Vector6::new(0.01, -0.02, 0.02, 0.01, 0.02, 0.01));
        let ids: Vec<KeyframeId> = (0..10)
            .map(|i| map.add_keyframe(blank_frame(1), if i == 4 { at(i) * bent } else { at(i) }))
            .collect();
        let axis = mount().inverse().rotate(Vector3::z());
        let plane = Plane::of(&map, axis).unwrap();
        let tie = plane.tie(&map, ids[4], 7, 4).unwrap();
        assert!((tie.from_to.translation.z - mount().translation.z).abs() < 1e-9);
        assert!(tie.from_to.rotate(axis).angle(&Vector3::z()) < 1e-9);
        let along = |pose: Pose3| pose.translation.xy();
        assert!((along(tie.from_to) - along(at(4) * bent)).norm() < 1e-9, "it is free to go along the floor");
        map.move_keyframe(ids[5], Pose3::exp(Vector6::new(0.0, 0.0, 0.5, 0.0, 0.0, 0.0)) * at(5));
        assert_eq!(Plane::of(&map, axis).unwrap().tie(&map, ids[5], 7, 5), None);
        (0..5).for_each(|i| {
            map.move_keyframe(ids[i], Pose3::exp(Vector6::new(0.0, 0.0, i as f64, 0.0, 0.0, 0.0)) * at(i));
        });
        assert_eq!(Plane::of(&map, axis), None, "stairs");
    }
}
