//! Bundle adjustment of the keyframes around one.

use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::landmark_map::LandmarkMap;
use crate::optimisation::map_bundle::MapBundle;
use trundle_core::Pose3;
use trundle_optim::{BundleConfig, BundleSolver};

/// Numbers of keyframes of a local bundle adjustment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BundleSize {
    /// Keyframes that move.
    pub local: usize,
    /// Keyframes that stay fixed.
    pub fixed: usize,
}

/// Refines the keyframes covisible with `centre` and the landmarks that two or more keyframes observe. The other keyframes that observe
/// these landmarks are fixed; without any, the oldest keyframe is. Observations that disagree with the result at 95 % are removed.
pub(crate) fn refine_around(
    map: &mut LandmarkMap,
    centre: KeyframeId,
    model: &ObservationModel,
    size: BundleSize,
    config: &BundleConfig,
) {
    let mut bundle = bundle_around(map, centre, size);
    bundle.begin(map, model, config, BundleSolver::default());
    while !bundle.advance(usize::MAX) {}
    apply(map, &bundle, model);
}

/// The bundle adjustment around a keyframe, ready to begin.
pub(crate) fn bundle_around(map: &LandmarkMap, centre: KeyframeId, size: BundleSize) -> MapBundle {
    let (keyframes, landmarks) = window_around(map, centre, size);
    let first = map.first_keyframe();
    let mut bundle =
        MapBundle::of(map, keyframes.into_iter().map(|(id, fixed)| (id, fixed || Some(id) == first)));
    for id in landmarks {
        bundle.add(map, id);
    }
    bundle
}

/// Applies a bundle's present result. A landmark with one observer moves with that keyframe.
pub(crate) fn apply(map: &mut LandmarkMap, bundle: &MapBundle, model: &ObservationModel) {
    // Landmarks with several observers at the bundle's start are part of it, and get their poses from the bundle.
    map.transform_landmarks(single_view_landmark_moves(map, bundle));
    bundle.move_keyframes(map);
    bundle.move_landmarks(map);
    bundle.remove_outliers(map);
    bundle.landmarks().for_each(|id| map.refresh(id, model));
}

/// Motion of the landmarks that only one of the moved keyframes observes.
fn single_view_landmark_moves(map: &LandmarkMap, bundle: &MapBundle) -> Vec<(LandmarkId, Pose3)> {
    let mut carried = Vec::new();
    for (id, pose) in bundle.keyframes() {
        let (Some(keyframe), Some(moved)) = (map.live_keyframe(id), bundle.correction(map, id)) else {
            continue;
        };
        for landmark in keyframe.landmarks.iter().flatten().filter(|_| !pose.fixed) {
            let single_view_landmark_moves = map.landmark(*landmark).filter(|l| l.observations.len() == 1);
            carried.extend(single_view_landmark_moves.map(|_| (*landmark, moved)));
        }
    }
    carried
}

/// First keyframes of these keyframes' odometry. Odometry holds a group that shares few landmarks with others. Without odometry, a dozen
/// points moved four keyframes by 2 deg and 0.15 m.
fn odometry_sources<'a>(
    map: &'a LandmarkMap,
    keyframes: &'a [KeyframeId],
) -> impl Iterator<Item = KeyframeId> + 'a {
    let from = |id: &KeyframeId| map.keyframe(*id).odometry.map(|odometry| odometry.from);
    keyframes.iter().filter_map(from).filter(|from| map.live_keyframe(*from).is_some())
}

/// The keyframes around one, each with whether it is fixed, and the common landmarks of the moved ones.
fn window_around(
    map: &LandmarkMap,
    centre: KeyframeId,
    size: BundleSize,
) -> (Vec<(KeyframeId, bool)>, Vec<LandmarkId>) {
    let mut local: Vec<KeyframeId> = std::iter::once(centre)
        .chain(map.covisible(centre, 15).into_iter().map(|(id, _)| id))
        .take(size.local)
        .collect();
    let mut landmarks: Vec<LandmarkId> =
        local.iter().flat_map(|k| map.keyframe(*k).landmarks.iter().flatten().copied()).collect();
    landmarks.sort_unstable();
    landmarks.dedup();
    landmarks.retain(|id| map.landmark(*id).is_some_and(|l| l.observations.len() >= 2));
    let others = map.keyframes_seeing(landmarks.iter().copied()).into_iter().map(|(id, _)| id);
    let mut fixed: Vec<KeyframeId> = others.filter(|id| !local.contains(id)).take(size.fixed).collect();
    if fixed.is_empty() {
        let oldest = local.iter().enumerate().min_by_key(|(_, id)| **id).map_or(0, |(i, _)| i);
        fixed.push(local.remove(oldest));
    }
    for from in odometry_sources(map, &local) {
        if !local.contains(&from) && !fixed.contains(&from) {
            fixed.push(from);
        }
    }
    let keyframes = local.into_iter().map(|id| (id, false)).chain(fixed.into_iter().map(|id| (id, true)));
    (keyframes.collect(), landmarks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::odometry_factor::OdometryFactor;
    use crate::map::reference_patch::ReferencePatch;
    use crate::testing::{blank_frame, model, painted_frame, painted_map, painted_points};
    use nalgebra::Vector6;
    use trundle_core::{Vector2, Vector3};
    use trundle_vision::ImagePatch;

    /// Keyframes in a row, each with odometry from the one before. The last two observe forty points together; the first keyframe observes
    /// one of these.
    fn row(count: usize) -> (LandmarkMap, Vec<KeyframeId>) {
        let mut map = LandmarkMap::default();
        let at = |i: usize| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * 0.1 * i as f64);
        let ids: Vec<_> = (0..count).map(|i| map.add_keyframe(blank_frame(40), at(i))).collect();
        for pair in ids.windows(2) {
            map.keyframe_mut(pair[1]).odometry = Some(OdometryFactor::at(pair[0]));
        }
        for feature in 0..40 {
            let landmark = map.add_landmark(Vector3::new(feature as f64, 0.0, 3.0));
            ids[count - 2..].iter().for_each(|id| assert!(map.observe(landmark, *id, feature)));
            if feature == 0 {
                map.observe(landmark, ids[0], feature);
            }
        }
        (map, ids)
    }

    #[test]
    fn odometry_holds_a_group_that_shares_few_landmarks() {
        let (map, ids) = row(6);
        let (keyframes, _) = window_around(&map, ids[5], BundleSize { local: 10, fixed: 10 });
        assert_eq!(keyframes, [(ids[5], false), (ids[4], false), (ids[0], true), (ids[3], true)]);
    }

    #[test]
    fn landmarks_of_one_keyframe_move_along_once_with_their_patches() {
        let (model, points, (mut map, first)) = (model(), painted_points(), painted_map());
        let truth = Pose3::exp(Vector6::new(0.2, 0.0, 0.0, 0.0, -0.1, 0.0));
        let off = Pose3::exp(Vector6::new(0.02, -0.01, 0.01, 0.0, 0.02, 0.01));
        let ids: Vec<LandmarkId> = map.landmarks().map(|(id, _)| id).collect();
        let second = map.add_keyframe(painted_frame(truth, &points, Vector2::zeros()), truth * off);
        ids.iter().enumerate().skip(2).for_each(|(feature, id)| assert!(map.observe(*id, second, feature)));
        let displaced = truth * off * truth.inverse();
        let own = map.add_landmark(displaced.transform(points[0]));
        map.observe(own, second, 0);
        let [right, down, toward_camera] =
            [Vector3::x(), Vector3::y(), -Vector3::z()].map(|v| displaced.rotate(v));
        let image = ImagePatch::new([0; 441], [0.0; 2]).unwrap();
        map.landmark_mut(own).unwrap().reference_patches.push(ReferencePatch {
            image,
            right,
            down,
            toward_camera,
        });
        let mut bundle = bundle_around(&map, second, BundleSize { local: 10, fixed: 10 });
        bundle.begin(&map, &model, &BundleConfig::default(), BundleSolver::default());
        while !bundle.advance(usize::MAX) {}
        // Keyframe culling removes landmarks during a bundle in the same way.
        map.unobserve(ids[2], first);
        apply(&mut map, &bundle, &model);
        for (id, truth) in [(own, points[0]), (ids[2], points[2])] {
            let off = (map.landmark(id).unwrap().position - truth).norm();
            assert!(off < 5e-3, "{id:?} is {off} m off");
        }
        let look = &map.landmark(own).unwrap().reference_patches[0];
        assert!(
            (look.toward_camera + Vector3::z()).norm() < 5e-3 && (look.right - Vector3::x()).norm() < 5e-3
        );
    }

    #[test]
    fn a_fixed_keyframe_is_in_the_window_once() {
        let (mut map, ids) = row(6);
        map.keyframe_mut(ids[4]).odometry = Some(OdometryFactor::at(ids[0]));
        let (keyframes, _) = window_around(&map, ids[5], BundleSize { local: 10, fixed: 10 });
        assert_eq!(keyframes, [(ids[5], false), (ids[4], false), (ids[0], true)]);
    }
}
