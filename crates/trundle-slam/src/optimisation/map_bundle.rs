//! A bundle adjustment that runs while the map changes.

use crate::frame::observation_model::ObservationModel;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::landmark_map::LandmarkMap;
use crate::optimisation::constraints::odometry_and_floor_constraints;
use nalgebra::Matrix6;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{BundleConfig, BundleObservation, BundlePose, BundleProblem, BundleSolver, CHI2_95_2};

/// A bundle adjustment of some keyframes and landmarks.
///
/// Its result replaces changes made during the adjustment, since poses and points of one bundle fit each other. Keyframes and landmarks
/// outside the bundle move by corrections: from a keyframe's present pose to its pose in the bundle.
#[derive(Debug, Clone, Default)]
pub(crate) struct MapBundle {
    /// Keyframes by rising id: the pose at the time of adding, and whether it is fixed.
    keyframes: Vec<(KeyframeId, BundlePose)>,
    /// Landmarks by rising id, with their positions at the time of adding.
    landmarks: Vec<(LandmarkId, Vector3)>,
    observations: Vec<BundleObservation>,
    /// Landmark, keyframe and bound of each observation.
    sources: Vec<(LandmarkId, KeyframeId, f64)>,
    /// Part of the map of each keyframe, by index; empty for a single part.
    parts: Vec<usize>,
    solver: BundleSolver,
    is_done: bool,
}

impl MapBundle {
    /// A bundle of keyframes, each with whether it is fixed.
    pub fn of(map: &LandmarkMap, keyframes: impl Iterator<Item = (KeyframeId, bool)>) -> Self {
        let pose = |(id, fixed): (KeyframeId, bool)| {
            let world_from_camera = map.keyframe(id).visual_from_camera;
            (id, BundlePose { world_from_camera, fixed })
        };
        let mut keyframes: Vec<_> = keyframes.map(pose).collect();
        keyframes.sort_unstable_by_key(|(id, _)| *id);
        Self { keyframes, ..Self::default() }
    }

    /// Adds a landmark with its observations in these keyframes, if two or more; returns their number. Landmarks must be added by rising
    /// id.
    pub fn add(&mut self, map: &LandmarkMap, id: LandmarkId) -> usize {
        let Some(landmark) = map.landmark(id) else { return 0 };
        let start = self.observations.len();
        for (keyframe, feature) in &landmark.observations {
            let Some(pose) = self.place_of(*keyframe) else { continue };
            let seen = map.keyframe(*keyframe).frame.observation(*feature);
            self.observations.push(BundleObservation { pose, point: self.landmarks.len(), seen });
            self.sources.push((id, *keyframe, seen.chi2_bound()));
        }
        let count = self.observations.len() - start;
        if count < 2 {
            self.observations.truncate(start);
            self.sources.truncate(start);
            return 0;
        }
        self.landmarks.push((id, landmark.position));
        count
    }

    /// Indices of the keyframes that observe the landmark added last.
    pub fn newest_observers(&self) -> impl Iterator<Item = usize> + '_ {
        let newest = self.landmarks.len().wrapping_sub(1);
        self.observations.iter().rev().take_while(move |o| o.point == newest).map(|o| o.pose)
    }

    /// Index of a keyframe among those of the bundle.
    pub fn place_of(&self, id: KeyframeId) -> Option<usize> {
        self.keyframes.binary_search_by_key(&id, |(own, _)| *own).ok()
    }

    /// The keyframes of the bundle, by rising id.
    pub fn keyframes(&self) -> impl Iterator<Item = (KeyframeId, BundlePose)> + '_ {
        self.keyframes.iter().copied()
    }

    /// Sets which keyframes are fixed.
    pub fn fix(&mut self, is_fixed: impl Fn(usize) -> bool) {
        self.keyframes.iter_mut().enumerate().for_each(|(i, (_, pose))| pose.fixed = is_fixed(i));
    }

    /// Sets the part of the map of each keyframe, by index. Parts share so few landmarks that those may be chance matches.
    pub fn set_parts(&mut self, parts: Vec<usize>) {
        self.parts = parts;
    }

    /// Starts refining, with the buffers of an earlier solver.
    pub fn begin(
        &mut self,
        map: &LandmarkMap,
        model: &ObservationModel,
        config: &BundleConfig,
        solver: BundleSolver,
    ) {
        self.solver = solver;
        let ids: Vec<KeyframeId> = self.keyframes.iter().map(|(id, _)| *id).collect();
        let constraints = odometry_and_floor_constraints(map, &ids, |i| self.keyframes[i].1.fixed);
        let world = BundlePose { world_from_camera: Pose3::identity(), fixed: true };
        let poses = self.keyframes.iter().map(|(_, pose)| *pose).chain([world]).collect();
        let points = self.landmarks.iter().map(|(_, point)| *point).collect();
        let observations = std::mem::take(&mut self.observations);
        let mut parts = std::mem::take(&mut self.parts);
        if !parts.is_empty() {
            parts.resize(self.keyframes.len() + 1, 0);
        }
        let problem = BundleProblem::new(model.camera, poses, points, observations)
            .and_then(|problem| problem.with_constraints(constraints))
            .and_then(|problem| if parts.is_empty() { Ok(problem) } else { problem.with_parts(parts) });
        self.solver.begin(&problem.expect("invariant: every index was counted here"), config);
    }

    /// The solver, for its buffers, after the result was applied.
    pub fn into_solver(self) -> BundleSolver {
        self.solver
    }

    /// Continues for about `work` units of the solver. Returns whether the adjustment is complete.
    pub fn advance(&mut self, work: usize) -> bool {
        self.is_done = self.solver.advance(work);
        self.is_done
    }

    /// Correction of a keyframe's present pose, `new_from_old` in the visual frame; `None` for a keyframe outside the bundle, or a removed
    /// one.
    pub fn correction(&self, map: &LandmarkMap, id: KeyframeId) -> Option<Pose3> {
        let now = map.live_keyframe(id)?.visual_from_camera;
        Some(self.solver.poses()[self.place_of(id)?] * now.inverse())
    }

    /// Moves the free keyframes that still exist.
    pub fn move_keyframes(&self, map: &mut LandmarkMap) {
        for ((id, _), pose) in self.keyframes.iter().zip(self.solver.poses()).filter(|((_, k), _)| !k.fixed) {
            if map.live_keyframe(*id).is_some() {
                map.move_keyframe(*id, pose.renormalized());
            }
        }
    }

    /// Moves the landmarks that still exist.
    pub fn move_landmarks(&self, map: &mut LandmarkMap) {
        for ((id, _), position) in self.landmarks.iter().zip(self.solver.points()) {
            if let Some(landmark) = map.landmark_mut(*id) {
                landmark.position = *position;
            }
        }
    }

    /// Whether the bundle contains the landmark.
    pub fn has(&self, id: LandmarkId) -> bool {
        self.landmarks.binary_search_by_key(&id, |(own, _)| *own).is_ok()
    }

    /// Removes observations that disagree with the final result at 95 %.
    pub fn remove_outliers(&self, map: &mut LandmarkMap) {
        if !self.is_done {
            return;
        }
        for ((landmark, keyframe, bound), chi2) in self.sources.iter().zip(self.solver.chi2()) {
            if chi2 > bound {
                map.unobserve(*landmark, *keyframe);
            }
        }
    }

    /// The landmarks of the bundle.
    pub fn landmarks(&self) -> impl Iterator<Item = LandmarkId> + '_ {
        self.landmarks.iter().map(|(id, _)| *id)
    }

    /// Mean square of the agreeing observations' residuals in their variances (the variance of unit weight). 1 if every sigma is correct.
    pub fn variance_factor(&self) -> f64 {
        let free = self.keyframes.iter().filter(|(_, pose)| !pose.fixed).count();
        let mut freedoms = -(6.0 * free as f64 + 3.0 * self.landmarks.len() as f64);
        let mut sum = 0.0;
        for ((_, _, bound), chi2) in self.sources.iter().zip(self.solver.chi2()).filter(|(s, c)| **c <= s.2) {
            freedoms += if *bound > CHI2_95_2 { 3.0 } else { 2.0 };
            sum += chi2;
        }
        if freedoms > 0.0 { sum / freedoms } else { 1.0 }
    }

    /// Number of the bundle's landmarks in each keyframe, by index.
    pub fn seen(&self) -> Vec<usize> {
        let mut seen = vec![0; self.keyframes.len()];
        for place in self.sources.iter().filter_map(|(_, keyframe, _)| self.place_of(*keyframe)) {
            seen[place] += 1;
        }
        seen
    }

    /// Covariance of a free keyframe relative to the fixed ones, and the part of it that its landmarks share, as of one rigid body.
    /// `None` if the bundle did not compute them.
    pub fn covariances(&self, place: usize) -> Option<(Matrix6<f64>, Matrix6<f64>)> {
        let whole = self.solver.covariance(place)?;
        let own = self.solver.information(place)?.cholesky()?.inverse();
        let eigen = (whole - own).symmetric_eigen();
        let cut = Matrix6::from_diagonal(&eigen.eigenvalues.map(|value| value.max(0.0)));
        Some((whole, eigen.eigenvectors * cut * eigen.eigenvectors.transpose()))
    }
}
