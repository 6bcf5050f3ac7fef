use crate::ids::KeyframeId;
use crate::landmark::Landmark;
use crate::map::LandmarkMap;
use crate::sensor::Sensor;
use nalgebra::{Matrix3, Matrix6};
use std::collections::BTreeMap;
use trundle_core::Vector3;
use trundle_optim::adjoint;

/// How well what two keyframes both see holds them to each other: of each pair of places in `ids` (by rising id) the
/// information of where the second one is in the frame of the first, a right perturbation.
///
/// Each keyframe sees a common landmark X with an information A and B (visual frame, in it the Huber weight of its residual);
/// with X itself unknown, they are held at it by (A^-1 + B^-1)^-1, and a turn about the origin moves it by -X^. A landmark
/// that n keyframes see ties n (n - 1) / 2 pairs, but says no more than n - 1 things: it counts 2 / n in each.
pub(super) fn common_sight(
    map: &LandmarkMap,
    sensor: &Sensor,
    ids: &[KeyframeId],
    pairs: impl Iterator<Item = (usize, usize)>,
) -> BTreeMap<(usize, usize), Matrix6<f64>> {
    let mut known: BTreeMap<(usize, usize), Matrix6<f64>> =
        pairs.map(|pair| (pair, Matrix6::zeros())).collect();
    for (_, landmark) in map.landmarks() {
        let views = views(map, sensor, ids, landmark);
        for (i, (a, by_a)) in views.iter().enumerate() {
            for (b, by_b) in &views[i + 1..] {
                let Some(sum) = known.get_mut(&(*a, *b)) else { continue };
                let Some(both) = (by_a + by_b).try_inverse() else { continue };
                *sum += of_bodies(by_a * both * by_b, landmark.position) * (2.0 / views.len() as f64);
            }
        }
    }
    for ((_, b), information) in &mut known {
        let by_right = adjoint(map.keyframe(ids[*b]).visual_from_camera);
        *information = by_right.transpose() * *information * by_right;
    }
    known
}

/// Which keyframes see a landmark, by rising place, and how well.
fn views(
    map: &LandmarkMap,
    sensor: &Sensor,
    ids: &[KeyframeId],
    landmark: &Landmark,
) -> Vec<(usize, Matrix3<f64>)> {
    let view = |(id, feature): &(KeyframeId, usize)| {
        let place = ids.binary_search(id).ok()?;
        let keyframe = map.keyframe(*id);
        let seen = sensor.observation(&keyframe.frame, *feature);
        let p_camera = keyframe.visual_from_camera.inverse().transform(landmark.position);
        let linear = seen.linearize(&sensor.camera, p_camera)?;
        let weight = seen.huber().weight(linear.residual.norm_squared());
        let by_point = linear.by_point * keyframe.visual_from_camera.rotation_matrix().transpose();
        Some((place, by_point.transpose() * by_point * weight))
    };
    let mut views: Vec<(usize, Matrix3<f64>)> = landmark.observations.iter().filter_map(view).collect();
    views.sort_unstable_by_key(|(place, _)| *place);
    views
}

/// The information of the motion of a body about the origin (translation, rotation) from that of one point's motion.
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
