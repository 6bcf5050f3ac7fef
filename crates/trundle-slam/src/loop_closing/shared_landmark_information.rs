//! The information that common landmarks give about the relative pose of two keyframes.

use crate::frame::observation_model::ObservationModel;
use crate::ids::KeyframeId;
use crate::map::landmark::Landmark;
use crate::map::landmark_map::LandmarkMap;
use nalgebra::{Matrix3, Matrix6};
use std::collections::BTreeSet;
use trundle_core::Vector3;

/// Information of the relative pose of each pair of keyframes from the landmarks that both see, as a right perturbation. Pairs
/// are indices into `ids` (by rising id), the lower first.
///
/// Each keyframe observes a common landmark X with an information A and B (visual frame, with the Huber weight of its residual).
/// With X itself unknown, the relative pose has the information (A^-1 + B^-1)^-1 of X, and a rotation around the origin moves X
/// by -X^. A landmark of n keyframes counts in n (n - 1) / 2 pairs but gives n - 1 constraints: its weight is 2 / n in each pair.
pub(crate) fn shared_landmark_information(
    map: &LandmarkMap,
    model: &ObservationModel,
    ids: &[KeyframeId],
    pairs: BTreeSet<(usize, usize)>,
) -> Vec<((usize, usize), Matrix6<f64>)> {
    let mut slots: Vec<Vec<(usize, usize)>> = vec![vec![]; ids.len()];
    pairs.iter().enumerate().for_each(|(slot, (a, b))| slots[*a].push((*b, slot)));
    let mut known: Vec<_> = pairs.into_iter().map(|pair| (pair, Matrix6::zeros())).collect();
    for (_, landmark) in map.landmarks().filter(|(_, landmark)| landmark.observations.len() > 1) {
        let views = views(map, model, ids, landmark);
        for (i, (a, by_a)) in views.iter().enumerate() {
            for (b, by_b) in &views[i + 1..] {
                let Ok(at) = slots[*a].binary_search_by_key(b, |(other, _)| *other) else { continue };
                let Some(both) = (by_a + by_b).try_inverse() else { continue };
                known[slots[*a][at].1].1 +=
                    of_bodies(by_a * both * by_b, landmark.position) * (2.0 / views.len() as f64);
            }
        }
    }
    for ((_, b), information) in &mut known {
        let by_right = map.keyframe(ids[*b]).visual_from_camera.adjoint();
        *information = by_right.transpose() * *information * by_right;
    }
    known
}

/// The observers of a landmark, by rising index, with their information.
fn views(
    map: &LandmarkMap,
    model: &ObservationModel,
    ids: &[KeyframeId],
    landmark: &Landmark,
) -> Vec<(usize, Matrix3<f64>)> {
    let view = |(id, feature): &(KeyframeId, usize)| {
        let place = ids.binary_search(id).ok()?;
        let keyframe = map.keyframe(*id);
        let seen = keyframe.frame.observation(*feature);
        let p_camera = keyframe.visual_from_camera.inverse().transform(landmark.position);
        let linear = seen.linearize(&model.camera, p_camera)?;
        let weight = seen.huber().weight(linear.residual.norm_squared());
        let by_point = linear.by_point * keyframe.visual_from_camera.rotation_matrix().transpose();
        Some((place, by_point.transpose() * by_point * weight))
    };
    let mut views: Vec<(usize, Matrix3<f64>)> = landmark.observations.iter().filter_map(view).collect();
    views.sort_unstable_by_key(|(place, _)| *place);
    views
}

/// The information of the motion of a body around the origin (translation, rotation) from that of one point's motion.
fn of_bodies(of_point: Matrix3<f64>, point: Vector3) -> Matrix6<f64> {
    let by_turn = -point.cross_matrix();
    let mixed = of_point * by_turn;
    let mut information = Matrix6::zeros();
    information.fixed_view_mut::<3, 3>(0, 0).copy_from(&of_point);
    information.fixed_view_mut::<3, 3>(0, 3).copy_from(&mixed);
    information.fixed_view_mut::<3, 3>(3, 0).copy_from(&mixed.transpose());
    information.fixed_view_mut::<3, 3>(3, 3).copy_from(&(by_turn.transpose() * mixed));
    information
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{frame_with_depth, model};
    use nalgebra::{Matrix3x6, Vector6};
    use trundle_core::Pose3;

    #[test]
    fn the_information_is_the_schur_complement_of_the_landmarks() {
        let (mut map, model) = (LandmarkMap::default(), model());
        let poses =
            [Vector6::new(0.3, -0.1, 0.2, 0.1, 0.4, -0.2), Vector6::new(0.5, 0.1, 0.1, 0.0, 0.3, -0.1)];
        let ids = poses.map(|pose| map.add_keyframe(frame_with_depth(60), Pose3::exp(pose)));
        let mut schur = Matrix6::zeros();
        for feature in 0..60 {
            let (a, b) = (map.keyframe(ids[0]), map.keyframe(ids[1]));
            let point = b.visual_from_camera.transform(b.frame.point(feature, &model).unwrap());
            let by_point = |keyframe: &crate::map::keyframe::Keyframe| {
                let p_camera = keyframe.visual_from_camera.inverse().transform(point);
                let seen = keyframe.frame.observation(feature);
                let linear = seen.linearize(&model.camera, p_camera).unwrap();
                let weight = seen.huber().weight(linear.residual.norm_squared()).sqrt();
                (linear.by_point * weight, p_camera)
            };
            let ((by_a, _), (by_b, p_camera)) = (by_point(a), by_point(b));
            // In b's frame the point moves by -rho + p x phi, and A is rotated into that frame.
            let mut by_pose = Matrix3x6::zeros();
            by_pose.fixed_view_mut::<3, 3>(0, 0).copy_from(&-Matrix3::identity());
            by_pose.fixed_view_mut::<3, 3>(0, 3).copy_from(&p_camera.cross_matrix());
            let jacobian = by_b * by_pose;
            let a_from_b = (a.visual_from_camera.inverse() * b.visual_from_camera).rotation_matrix();
            let by_a = by_a * a_from_b;
            let points = by_a.transpose() * by_a + by_b.transpose() * by_b;
            let mixed = jacobian.transpose() * by_b;
            schur +=
                jacobian.transpose() * jacobian - mixed * points.try_inverse().unwrap() * mixed.transpose();
            let landmark = map.add_landmark(point);
            assert!(map.observe(landmark, ids[0], feature) && map.observe(landmark, ids[1], feature));
        }
        let known = shared_landmark_information(&map, &model, &ids, BTreeSet::from([(0, 1)]));
        let off = (known[0].1 - schur).norm() / schur.norm();
        assert!(off < 1e-9, "{off}");
    }
}
