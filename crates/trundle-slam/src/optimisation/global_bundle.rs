//! Bundle adjustment of the whole map.

use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::landmark_map::LandmarkMap;
use crate::motion::uncertain_pose::propagated;
use crate::optimisation::map_bundle::MapBundle;
use std::collections::BTreeMap;
use trundle_core::Pose3;
use trundle_optim::{BundleConfig, BundlePose, BundleSolver};

/// Fewest common landmarks of two keyframes in one part of the map: 15. With fewer, they belong to separate parts. Source: \[MurArtal17\].
const MIN_SHARED_LANDMARKS: u16 = 15;
/// Units of work to add one observation to the bundle: 5, measured relative to the solver's units. Source: ours.
const WORK_PER_OBSERVATION: usize = 5;

/// Bundle adjustment of the whole map, in slices between frames \[MurArtal17, sec. III-D\].
///
/// Landmarks are added in slices, then the solver runs in slices, then all poses and landmarks are moved at once. A keyframe added during
/// the adjustment moves with its parent in the spanning tree, a landmark with the first keyframe that observes it. At the end the
/// covariances of all keyframes are computed from all constraints, each landmark counted once.
#[derive(Debug, Clone, Default)]
pub(crate) struct GlobalBundle {
    bundle: MapBundle,
    /// Index of the next landmark to add; `None` while the solver runs.
    next: Option<usize>,
    /// Number of common landmarks of each two keyframes: indices a < b at b (b - 1) / 2 + a.
    shared: Vec<u16>,
    /// The index of the fixed keyframe of each keyframe's part of the map.
    anchors: Vec<usize>,
}

impl GlobalBundle {
    pub fn of(map: &LandmarkMap) -> Self {
        let bundle = MapBundle::of(map, map.keyframe_ids().map(|id| (id, true)));
        let count = bundle.keyframes().count();
        Self {
            bundle,
            next: Some(0),
            shared: vec![0; count * count.saturating_sub(1) / 2],
            anchors: Vec::new(),
        }
    }

    /// Continues for about `work` units. Returns whether the adjustment is complete. `solver` lends its buffers.
    pub fn advance(
        &mut self,
        map: &LandmarkMap,
        model: &ObservationModel,
        (config, solver): (&BundleConfig, &mut BundleSolver),
        work: usize,
    ) -> bool {
        let Some(next) = self.next else { return self.bundle.advance(work) };
        let (bound, mut left, mut index) = (map.landmark_bound(), work, next);
        while index < bound && left > 0 {
            let seen = self.bundle.add(map, LandmarkId::from_index(index));
            if seen > 0 {
                self.count_shared();
            }
            left = left.saturating_sub((WORK_PER_OBSERVATION + seen) * seen + 1);
            index += 1;
        }
        self.next = Some(index).filter(|index| *index < bound);
        if self.next.is_none() {
            self.fix_gauge(map);
            self.bundle.begin(map, model, config, std::mem::take(solver));
        }
        false
    }

    fn count_shared(&mut self) {
        let observers: Vec<usize> = self.bundle.newest_observers().collect();
        for (i, a) in observers.iter().enumerate() {
            for b in &observers[i + 1..] {
                let (low, high) = (*a.min(b), *a.max(b));
                let count = &mut self.shared[high * (high - 1) / 2 + low];
                *count = count.saturating_add(1);
            }
        }
    }

    /// Fixes the oldest keyframe of every part of the map that shares too few landmarks with the rest, and that no odometry
    /// connects to it.
    fn fix_gauge(&mut self, map: &LandmarkMap) {
        let count = self.bundle.keyframes().count();
        let pairs = (0..count).flat_map(|b| (0..b).map(move |a| (a, b)));
        let shared = pairs
            .zip(&self.shared)
            .filter(|(_, count)| **count >= MIN_SHARED_LANDMARKS)
            .map(|(pair, _)| pair);
        let odometry = |(place, (id, _)): (usize, (KeyframeId, BundlePose))| {
            Some((self.bundle.place_of(map.live_keyframe(id)?.odometry?.from)?, place))
        };
        let odometry: Vec<(usize, usize)> =
            self.bundle.keyframes().enumerate().filter_map(odometry).collect();
        let parts = join_sets((0..count).collect(), shared);
        self.anchors = join_sets(parts.clone(), odometry.into_iter());
        let parts = self.join_by_total(parts);
        let anchors = &self.anchors;
        self.bundle.fix(|i| anchors[i] == i);
        self.bundle.set_parts(parts);
    }

    /// Joins two parts that share enough landmarks over all their keyframes: chance matches stay below that number.
    fn join_by_total(&self, parts: Vec<usize>) -> Vec<usize> {
        let mut between: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let pairs = (0..parts.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        for ((a, b), count) in pairs.zip(&self.shared).filter(|((a, b), _)| parts[*a] != parts[*b]) {
            let (a, b) = (parts[a], parts[b]);
            *between.entry((a.min(b), a.max(b))).or_default() += usize::from(*count);
        }
        let enough = between.into_iter().filter(|(_, count)| *count >= usize::from(MIN_SHARED_LANDMARKS));
        join_sets(parts, enough.map(|(pair, _)| pair))
    }

    /// Applies the result to the map.
    pub fn apply(&self, map: &mut LandmarkMap) {
        let moved = self.corrections(map);
        let others = self.other_landmarks(map, &moved);
        self.bundle.move_landmarks(map);
        map.transform_landmarks(others);
        for (id, correction) in &moved {
            let pose = *correction * map.keyframe(*id).visual_from_camera;
            map.move_keyframe(*id, pose.renormalized());
        }
        self.bundle.remove_outliers(map);
        self.set_covariances(map);
    }

    /// The lent solver, for its buffers; `None` before the solver started.
    pub fn into_solver(self) -> Option<BundleSolver> {
        self.next.is_none().then(|| self.bundle.into_solver())
    }

    /// Motion of each keyframe of the map; a newer keyframe moves as its parent.
    fn corrections(&self, map: &LandmarkMap) -> BTreeMap<KeyframeId, Pose3> {
        let mut moved: BTreeMap<KeyframeId, Pose3> = BTreeMap::new();
        for (id, keyframe) in map.keyframes() {
            // Parents are older than their children, except after the removal of a keyframe in between.
            let by_parent = || {
                let mut parent = keyframe.tree.parent;
                while let Some(id) = parent {
                    if let Some(known) = self.bundle.correction(map, id) {
                        return known;
                    }
                    parent = map.keyframe(id).tree.parent;
                }
                Pose3::identity()
            };
            moved.insert(id, self.bundle.correction(map, id).unwrap_or_else(by_parent));
        }
        moved
    }

    /// Motion of the landmarks outside the bundle: that of the first keyframe that observes each.
    fn other_landmarks(
        &self,
        map: &LandmarkMap,
        moved: &BTreeMap<KeyframeId, Pose3>,
    ) -> Vec<(LandmarkId, Pose3)> {
        let others = map.landmarks().filter(|(id, _)| !self.bundle.has(*id));
        others
            .filter_map(|(id, landmark)| {
                let (first, _) = landmark.observations.iter().min()?;
                Some((id, *moved.get(first)?))
            })
            .collect()
    }

    fn set_covariances(&self, map: &mut LandmarkMap) {
        let factor = self.bundle.variance_factor().max(1.0);
        let keyframes: Vec<KeyframeId> = self.bundle.keyframes().map(|(id, _)| id).collect();
        let seen = self.bundle.seen();
        for (place, id) in keyframes.iter().enumerate().filter(|(place, _)| self.anchors[*place] != *place) {
            let Some(holding) = map.live_keyframe(keyframes[self.anchors[place]]) else { continue };
            let Some(keyframe) = map.live_keyframe(*id) else { continue };
            let Some((whole, map_covariance)) = self.bundle.covariances(place) else { continue };
            // With few common landmarks, all landmarks of the keyframe have its whole uncertainty.
            let map_covariance =
                if seen[place] < usize::from(MIN_SHARED_LANDMARKS) { whole } else { map_covariance };
            let offset = holding.visual_from_camera.inverse() * keyframe.visual_from_camera;
            let held = propagated(&holding.covariance, offset);
            map.set_covariances(*id, held + whole * factor, held + map_covariance * factor);
        }
    }
}

/// Lowest member of each element's set, after the pairs have joined their sets.
fn join_sets(mut sets: Vec<usize>, pairs: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let find = |sets: &[usize], mut i: usize| {
        while sets[i] != i {
            i = sets[i];
        }
        i
    };
    for (a, b) in pairs {
        let (a, b) = (find(&sets, a), find(&sets, b));
        sets[a.max(b)] = a.min(b);
    }
    (0..sets.len()).map(|i| find(&sets, i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::rgbd_frame::Frame;
    use crate::map::odometry_factor::OdometryFactor;
    use crate::motion::uncertain_pose::{UncertainPose, of_sigmas};
    use crate::testing::model;
    use nalgebra::{Matrix6, Vector6};
    use trundle_core::{Stamp, Vector3};
    use trundle_optim::InverseDepth;
    use trundle_vision::{Descriptor, Features, Keypoint};

    fn along(x: f64) -> Pose3 {
        Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, -0.1 * x, 0.0))
    }

    fn points() -> Vec<Vector3> {
        (0..30)
            .map(|i| Vector3::new(f64::from(i % 6) * 0.2 - 0.5, f64::from(i / 6) * 0.2 - 0.4, 2.0))
            .collect()
    }

    /// The exact view of the points.
    fn view(pose: Pose3) -> Frame {
        let (model, mut features, mut depths) = (model(), Features::default(), Vec::new());
        for point in points() {
            let p = pose.inverse().transform(point);
            let pixel = model.camera.project(p).unwrap();
            let (x, y) = (pixel.x as f32, pixel.y as f32);
            features.keypoints.push(Keypoint { x, y, octave: 0, angle: 0.0, response: 1.0 });
            features.descriptors.push(Descriptor::default());
            depths.push(Some(InverseDepth { value: 1.0 / p.z, sigma: 0.003 }));
        }
        Frame::of(Stamp::default(), features, depths, &model)
    }

    /// Five keyframes in a row, the third with an error, and two that share landmarks only with each other.
    fn bent() -> (LandmarkMap, Vec<KeyframeId>, Pose3) {
        let (mut map, off) =
            (LandmarkMap::default(), Pose3::exp(Vector6::new(0.03, -0.02, 0.01, 0.0, 0.02, 0.01)));
        let mut ids = Vec::new();
        for i in 0..7 {
            let truth = along(0.1 * f64::from(i));
            ids.push(map.add_keyframe(view(truth), if i == 2 { truth * off } else { truth }));
        }
        for group in [&ids[..5], &ids[5..]] {
            for (feature, point) in points().into_iter().enumerate() {
                let landmark = map.add_landmark(point);
                group.iter().for_each(|id| assert!(map.observe(landmark, *id, feature)));
            }
            group.iter().for_each(|id| map.add_to_spanning_tree(*id));
        }
        (map, ids, off)
    }

    #[test]
    fn keyframes_added_meanwhile_move_along_and_slices_change_nothing() {
        let run = |work: usize| {
            let (mut map, ids, off) = bent();
            let (model, mut config) = (model(), BundleConfig::default());
            config.covariances = true;
            map.set_covariance(ids[5], nalgebra::Matrix6::identity() * 0.04);
            let mut global = GlobalBundle::of(&map);
            global.advance(&map, &model, (&config, &mut BundleSolver::default()), 1);
            // A keyframe that was located by the corrected one, and a landmark that no other keyframe observes.
            let child =
                map.add_keyframe(view(along(0.25)), along(0.2) * off * along(0.2).inverse() * along(0.25));
            let own = map.add_landmark(
                (along(0.2) * off * along(0.2).inverse()).transform(Vector3::new(0.1, 0.2, 2.5)),
            );
            map.observe(own, child, 3);
            map.set_parent(child, ids[2]);
            while !global.advance(&map, &model, (&config, &mut BundleSolver::default()), work) {}
            global.apply(&mut map);
            (map, ids, child, own)
        };
        let (map, ids, child, own) = run(usize::MAX);
        for (i, id) in ids.iter().enumerate() {
            let gap = along(0.1 * i as f64).inverse() * map.keyframe(*id).visual_from_camera;
            assert!(gap.log().norm() < 1e-4, "{id}: {gap:?}");
        }
        let gap = along(0.25).inverse() * map.keyframe(child).visual_from_camera;
        assert!(gap.log().norm() < 1e-4, "the child is off: {gap:?}");
        assert!((map.landmark(own).unwrap().position - Vector3::new(0.1, 0.2, 2.5)).norm() < 1e-4);
        let variance = |id: KeyframeId| map.keyframe(id).covariance.trace();
        assert!(variance(ids[0]) == 0.0 && variance(ids[4]) > 0.0 && variance(ids[4]) < 1e-2);
        assert!(variance(ids[6]) > 0.2, "it has the uncertainty of its keyframe: {}", variance(ids[6]));
        let (sliced, ..) = run(500);
        for (id, keyframe) in map.keyframes() {
            assert_eq!(keyframe.visual_from_camera, sliced.keyframe(id).visual_from_camera);
            assert_eq!(keyframe.covariance, sliced.keyframe(id).covariance);
        }
    }

    /// Two parts of a map that only odometry connects.
    #[test]
    fn points_that_one_keyframe_sees_alone_are_as_uncertain_as_the_keyframe() {
        let (mut map, ids, _) = bent();
        let after = map.add_keyframe(view(along(1.0)), along(1.0));
        for (feature, point) in points().into_iter().enumerate() {
            let landmark = map.add_landmark(point);
            assert!(map.observe(landmark, after, feature));
        }
        map.add_to_spanning_tree(after);
        let covariance = of_sigmas(0.3, 0.01);
        let pose = along(0.4).inverse() * along(1.0);
        let factor = OdometryFactor { from: ids[4], from_to: UncertainPose { pose, covariance } };
        map.keyframe_mut(after).odometry = Some(factor);
        let (model, mut config) = (model(), BundleConfig::default());
        config.covariances = true;
        let mut global = GlobalBundle::of(&map);
        while !global.advance(&map, &model, (&config, &mut BundleSolver::default()), usize::MAX) {}
        global.apply(&mut map);
        let sigma = |m: &Matrix6<f64>| m[(0, 0)].sqrt();
        let seen = map.keyframe(after);
        assert!((0.29..0.4).contains(&sigma(&seen.covariance)), "{}", sigma(&seen.covariance));
        assert!(sigma(&seen.map_covariance) > 0.29, "pose by these points: {}", sigma(&seen.map_covariance));
        let before = map.keyframe(ids[4]);
        assert!(sigma(&before.map_covariance) < sigma(&before.covariance), "all its landmarks are shared");
    }
}
