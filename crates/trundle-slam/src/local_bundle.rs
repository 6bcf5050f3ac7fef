use crate::ids::{KeyframeId, LandmarkId};
use crate::map::LandmarkMap;
use crate::map_bundle::MapBundle;
use crate::sensor::Sensor;
use trundle_core::Vector3;
use trundle_optim::{BundleConfig, BundleSolver};

/// How much of the map is refined at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BundleSize {
    /// Keyframes that move.
    pub local: usize,
    /// Keyframes that hold them in place.
    pub fixed: usize,
}

/// Refines the keyframes covisible with `centre` and the landmarks that two or more keyframes see; the other keyframes
/// that see those hold still, or the oldest where there is none. Observations that then disagree at 95 % are taken back.
pub(crate) fn refine_around(
    map: &mut LandmarkMap,
    centre: KeyframeId,
    sensor: &Sensor,
    size: BundleSize,
    config: &BundleConfig,
) {
    let mut bundle = bundle_around(map, centre, sensor, size);
    bundle.begin(map, sensor, config, BundleSolver::default());
    while !bundle.advance(usize::MAX) {}
    apply(map, &bundle, sensor);
}

/// The bundle adjustment of what is around a keyframe, ready to begin.
pub(crate) fn bundle_around(
    map: &LandmarkMap,
    centre: KeyframeId,
    sensor: &Sensor,
    size: BundleSize,
) -> MapBundle {
    let (keyframes, landmarks) = window_around(map, centre, size);
    let first = map.first_keyframe();
    let mut bundle =
        MapBundle::of(map, keyframes.into_iter().map(|(id, fixed)| (id, fixed || Some(id) == first)));
    for id in landmarks {
        bundle.add(map, id, sensor);
    }
    bundle
}

/// Takes a bundle's result over, as far as it has come. A landmark that only one keyframe sees moves along with it.
pub(crate) fn apply(map: &mut LandmarkMap, bundle: &MapBundle, sensor: &Sensor) {
    let carried = alone(map, bundle);
    bundle.move_keyframes(map);
    bundle.move_landmarks(map);
    for (id, position) in carried {
        if let Some(landmark) = map.landmark_mut(id) {
            landmark.position = position;
        }
    }
    bundle.take_back(map);
    bundle.landmarks().for_each(|id| map.refresh(id, sensor));
}

/// Where the landmarks go that only one of the moved keyframes sees.
fn alone(map: &LandmarkMap, bundle: &MapBundle) -> Vec<(LandmarkId, Vector3)> {
    let mut carried = Vec::new();
    for (id, pose) in bundle.keyframes() {
        let (Some(keyframe), Some(moved)) = (map.live_keyframe(id), bundle.correction(map, id)) else {
            continue;
        };
        for landmark in keyframe.landmarks.iter().flatten().filter(|_| !pose.fixed) {
            let alone = map.landmark(*landmark).filter(|l| l.observations.len() == 1);
            carried.extend(alone.map(|l| (*landmark, moved.transform(l.position))));
        }
    }
    carried
}

/// The keyframes around one, each with whether it holds still, and the landmarks that the moved ones share.
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
    let keyframes = local.into_iter().map(|id| (id, false)).chain(fixed.into_iter().map(|id| (id, true)));
    (keyframes.collect(), landmarks)
}
