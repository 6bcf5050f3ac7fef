use crate::ids::{KeyframeId, LandmarkId};
use crate::map::LandmarkMap;
use crate::sensor::Sensor;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{BundleConfig, BundleObservation, BundlePose, BundleProblem, BundleSolution};

/// How much of the map is refined at once.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BundleSize {
    /// Keyframes that move.
    pub local: usize,
    /// Keyframes that hold them in place.
    pub fixed: usize,
}

/// The part of the map around a keyframe.
#[derive(Debug)]
struct Window {
    keyframes: Vec<KeyframeId>,
    /// How many of them, from the first, move.
    free: usize,
    landmarks: Vec<LandmarkId>,
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
    let window = window_around(map, centre, size);
    let (problem, sources) = problem(map, &window, sensor);
    let solution = problem.solve(config);
    apply(map, &window, &solution);
    for ((landmark, keyframe, bound), chi2) in sources.into_iter().zip(&solution.chi2) {
        if *chi2 > bound {
            map.unobserve(landmark, keyframe);
        }
    }
    for id in window.landmarks {
        map.refresh(id, sensor);
    }
}

fn window_around(map: &LandmarkMap, centre: KeyframeId, size: BundleSize) -> Window {
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
    let free = local.len();
    local.extend(fixed);
    Window { keyframes: local, free, landmarks }
}

/// The problem, and of each observation its landmark, keyframe and bound.
fn problem(
    map: &LandmarkMap,
    window: &Window,
    sensor: &Sensor,
) -> (BundleProblem, Vec<(LandmarkId, KeyframeId, f64)>) {
    let mut slots = vec![None; map.keyframe_bound()];
    for (slot, id) in window.keyframes.iter().enumerate() {
        slots[id.index()] = Some(slot);
    }
    let first = map.first_keyframe();
    let pose = |(slot, id): (usize, &KeyframeId)| BundlePose {
        world_from_camera: map.keyframe(*id).visual_from_camera,
        fixed: slot >= window.free || Some(*id) == first,
    };
    let poses = window.keyframes.iter().enumerate().map(pose).collect();
    let (mut points, mut observations, mut sources) = (Vec::new(), Vec::new(), Vec::new());
    for (id, landmark) in window.landmarks.iter().filter_map(|id| Some((*id, map.landmark(*id)?))) {
        for (keyframe, feature) in &landmark.observations {
            let Some(pose) = slots[keyframe.index()] else { continue };
            let seen = sensor.observation(&map.keyframe(*keyframe).frame, *feature);
            observations.push(BundleObservation { pose, point: points.len(), seen });
            sources.push((id, *keyframe, seen.chi2_bound()));
        }
        points.push(landmark.position);
    }
    let problem = BundleProblem::new(sensor.camera, poses, points, observations);
    (problem.expect("invariant: every index was counted here"), sources)
}

/// Moves keyframes and landmarks; a landmark that only one moved keyframe sees moves along with it.
fn apply(map: &mut LandmarkMap, window: &Window, solution: &BundleSolution) {
    let mut carried: Vec<(LandmarkId, Vector3)> = Vec::new();
    for (id, pose) in window.keyframes.iter().zip(&solution.poses).take(window.free) {
        let keyframe = map.keyframe(*id);
        let correction: Pose3 = *pose * keyframe.visual_from_camera.inverse();
        for landmark in keyframe.landmarks.iter().flatten() {
            let alone = map.landmark(*landmark).filter(|l| l.observations.len() == 1);
            carried.extend(alone.map(|l| (*landmark, correction.transform(l.position))));
        }
        map.move_keyframe(*id, *pose);
    }
    let refined = window.landmarks.iter().copied().zip(solution.points.iter().copied());
    for (id, position) in refined.chain(carried) {
        if let Some(landmark) = map.landmark_mut(id) {
            landmark.position = position;
        }
    }
}
