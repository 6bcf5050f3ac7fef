use crate::anchor::MAX_RELATIVE_SIGMA;
use crate::frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::landmark::Landmark;
use crate::look::keep_looks;
use crate::map::LandmarkMap;
use crate::rolled::Rolled;
use crate::search::{Likeness, Projection, search};
use crate::sensor::Sensor;
use crate::triangulation::triangulate_new;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3};
use trundle_optim::BundleConfig;

/// How the landmark map grows and is refined.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MappingConfig {
    /// Features with depth that a first keyframe needs, 10 or more. Default 50: fewer do not make a map.
    pub min_points: usize,
    /// Keyframes that a local bundle adjustment moves, 1 or more. Default 10: enough to see a landmark age.
    pub local_keyframes: usize,
    /// Keyframes that hold them in place. Default 10.
    pub fixed_keyframes: usize,
    /// Keyframes in which new landmarks are looked for at once. Default 10 \[MurArtal17\].
    pub fused_keyframes: usize,
    /// A landmark that only one keyframe sees is forgotten after so many more keyframes. Default 3 \[MurArtal17\].
    pub trial_keyframes: usize,
    /// Frames in which a landmark should have been seen before it is judged. Default 10.
    pub trial_frames: u32,
    /// Part of these in which it must have been found, 0 to 1. Default 0.25 \[MurArtal17\].
    pub found_ratio: f64,
    /// The solver. Default 5 steps.
    pub bundle: BundleConfig,
    /// How much of the refining of the map is done between one frame and the next, in operations of some 20 ns, 1 or more.
    /// Default 100,000: 2 ms. Never more than a tenth of a ms beyond it, but for taking a result over.
    pub work_per_frame: usize,
}

impl Default for MappingConfig {
    fn default() -> Self {
        Self {
            min_points: 50,
            local_keyframes: 10,
            fixed_keyframes: 10,
            fused_keyframes: 10,
            trial_keyframes: 3,
            trial_frames: 10,
            found_ratio: 0.25,
            bundle: BundleConfig { steps: 5, ..BundleConfig::default() },
            work_per_frame: 100_000,
        }
    }
}

impl MappingConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        if self.min_points < 10 {
            return Err(Invalid::new("mapping.min_points", self.min_points, "", "10 or more"));
        }
        let counts = [
            ("mapping.local_keyframes", self.local_keyframes),
            ("mapping.work_per_frame", self.work_per_frame),
        ];
        if let Some((name, _)) = counts.iter().find(|(_, count)| *count == 0) {
            return Err(Invalid::new(*name, 0, "", "1 or more"));
        }
        trundle_core::require_in("mapping.found_ratio", self.found_ratio, "", 0.0, 1.0)?;
        self.bundle = self.bundle.validated()?;
        Ok(self)
    }
}

/// Adds keyframes to the map and keeps it in order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mapper<'a> {
    pub sensor: &'a Sensor,
    pub config: &'a MappingConfig,
    /// For the search of new landmarks in other keyframes.
    pub likeness: Likeness,
    /// Half size of its window at octave 0, px.
    pub window: f64,
}

impl Mapper<'_> {
    /// Makes `frame` a keyframe that sees the landmarks it was tracked by, gives its other features with a good depth, or
    /// seen from two sides, landmarks of their own, looks for these in the keyframes around, and begins to refine all of them
    /// together. `rolled` is the way to it as wheels know it.
    pub fn insert(
        &self,
        map: &mut LandmarkMap,
        frame: Frame,
        pose: Pose3,
        (tracked, rolled): (&[Option<LandmarkId>], Option<Rolled>),
    ) -> KeyframeId {
        let keyframe = map.add_keyframe(frame, pose);
        map.keyframe_mut(keyframe).rolled = rolled;
        for (feature, landmark) in tracked.iter().enumerate().filter_map(|(i, l)| Some((i, (*l)?))) {
            map.observe(landmark, keyframe, feature);
        }
        map.enter_tree(keyframe);
        let mut new = self.add_landmarks(map, keyframe);
        new.extend(triangulate_new(map, keyframe, self.sensor, self.likeness));
        self.fuse(map, keyframe, new);
        for id in map.keyframe(keyframe).landmarks.clone().into_iter().flatten() {
            map.refresh(id, self.sensor);
        }
        keep_looks(map, keyframe, self.sensor);
        self.cull(map, keyframe);
        map.begin_refining(keyframe, self.sensor, self.config);
        keyframe
    }

    /// A landmark for every feature that has a good depth and no landmark yet.
    fn add_landmarks(&self, map: &mut LandmarkMap, id: KeyframeId) -> Vec<LandmarkId> {
        let keyframe = map.keyframe(id);
        let good = |i: &usize| {
            let depth = keyframe.frame.depths[*i].filter(|d| d.sigma <= MAX_RELATIVE_SIGMA * d.value);
            keyframe.landmarks[*i].is_none() && depth.is_some()
        };
        let place = |i: usize| {
            let point = self.sensor.point(&keyframe.frame, i)?;
            Some((i, keyframe.visual_from_camera.transform(point)))
        };
        let points: Vec<_> = (0..keyframe.frame.len()).filter(good).filter_map(place).collect();
        let mut new = Vec::with_capacity(points.len());
        for (feature, position) in points {
            let landmark = map.add_landmark(position);
            map.observe(landmark, id, feature);
            map.refresh(landmark, self.sensor);
            new.push(landmark);
        }
        new
    }

    /// Looks for the new landmarks in the keyframes around: one that is there already becomes the older landmark.
    fn fuse(&self, map: &mut LandmarkMap, keyframe: KeyframeId, new: Vec<LandmarkId>) {
        for (other, _) in map.covisible(keyframe, 15).into_iter().take(self.config.fused_keyframes) {
            self.fuse_into(map, other, &new);
        }
    }

    /// Looks for landmarks in a keyframe: where one is there already, the older of the two stays.
    pub fn fuse_into(&self, map: &mut LandmarkMap, keyframe: KeyframeId, landmarks: &[LandmarkId]) {
        for (feature, landmark) in self.find(map, keyframe, landmarks) {
            match map.keyframe(keyframe).landmarks[feature] {
                Some(other) => map.merge(other.min(landmark), other.max(landmark)),
                None => _ = map.observe(landmark, keyframe, feature),
            }
        }
    }

    /// Which features of a keyframe are of these landmarks, by descriptor, window and reprojection at 95 %.
    fn find(
        &self,
        map: &LandmarkMap,
        other: KeyframeId,
        landmarks: &[LandmarkId],
    ) -> Vec<(usize, LandmarkId)> {
        let other = map.keyframe(other);
        let camera_from_visual = other.visual_from_camera.inverse();
        let (mut sought, mut projections) = (Vec::new(), Vec::new());
        for (id, landmark) in landmarks.iter().filter_map(|id| Some((*id, map.landmark(*id)?))) {
            let seen = Projection::of(landmark, camera_from_visual, self.sensor, self.window);
            let Some((projection, p_camera)) = seen else { continue };
            projections.push(projection);
            sought.push((id, p_camera));
        }
        let agrees = |(feature, i): (usize, usize)| {
            let (id, p_camera) = sought[i];
            let seen = self.sensor.plain_observation(&other.frame, feature);
            (seen.chi2(&self.sensor.camera, p_camera) <= seen.chi2_bound()).then_some((feature, id))
        };
        let all = vec![true; other.frame.len()];
        search(&other.frame, &all, &projections, self.likeness).into_iter().filter_map(agrees).collect()
    }

    /// Forgets landmarks that no second keyframe saw in time, or that were seldom found where they should have been seen.
    /// Looks at what the keyframes around the new one see, and at the one whose landmarks have now been on trial for long
    /// enough.
    fn cull(&self, map: &mut LandmarkMap, new: KeyframeId) {
        let MappingConfig { trial_keyframes, trial_frames, found_ratio, .. } = *self.config;
        let Some(oldest_on_trial) = map.keyframe_ids().rev().nth(trial_keyframes) else { return };
        let judged = map.keyframe_ids().rev().nth(trial_keyframes + 1);
        let alone = |l: &Landmark| l.observations.len() == 1 && l.observations[0].0 < oldest_on_trial;
        let seldom = |l: &Landmark| {
            l.visible >= trial_frames && f64::from(l.found) < found_ratio * f64::from(l.visible)
        };
        let is_gone = |id: LandmarkId| map.landmark(id).is_some_and(|l| alone(l) || seldom(l));
        let near = map.around(map.keyframe(new).visual_from_camera);
        let seen = |id: KeyframeId| map.keyframe(id).landmarks.iter().flatten().copied();
        let gone: Vec<LandmarkId> =
            near.into_iter().chain(judged).flat_map(seen).filter(|id| is_gone(*id)).collect();
        gone.into_iter().for_each(|id| map.forget(id));
    }
}
