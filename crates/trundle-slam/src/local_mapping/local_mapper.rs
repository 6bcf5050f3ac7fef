//! Adds keyframes and landmarks to the map, and removes useless landmarks.

use crate::frame::depth::MAX_RELATIVE_SIGMA;
use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::local_mapping::config::LocalMappingConfig;
use crate::local_mapping::reference_patch_storage::store_reference_patches;
use crate::local_mapping::triangulation::triangulate_new;
use crate::map::covisibility::{MIN_SHARED_LANDMARKS, keyframes_around};
use crate::map::landmark::Landmark;
use crate::map::landmark_map::LandmarkMap;
use crate::map::odometry_factor::OdometryFactor;
use crate::matching::projection_search::{MatchThresholds, Projection, search};
use crate::tracking::config::TrackingConfig;
use trundle_core::Pose3;

/// Adds keyframes to the map, and removes redundant keyframes and bad landmarks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalMapper<'a> {
    pub model: &'a ObservationModel,
    pub config: &'a LocalMappingConfig,
    /// Thresholds for the search of new landmarks in other keyframes.
    pub thresholds: MatchThresholds,
    /// Half size of the search window at octave 0, px.
    pub window_px: f64,
}

impl<'a> LocalMapper<'a> {
    pub fn new(
        model: &'a ObservationModel,
        config: &'a LocalMappingConfig,
        tracking: &TrackingConfig,
    ) -> Self {
        let (thresholds, window_px) = (tracking.windowed_thresholds(), tracking.map_window_px);
        Self { model, config, thresholds, window_px }
    }

    /// Makes `frame` a keyframe that observes the landmarks it was tracked by. Other features with a good depth, or with two views, become
    /// new landmarks. The new landmarks are then searched in the neighbouring keyframes. `odometry` is the motion from the keyframe before.
    pub fn insert(
        &self,
        map: &mut LandmarkMap,
        frame: Frame,
        pose: Pose3,
        (tracked, odometry): (&[Option<LandmarkId>], Option<OdometryFactor>),
    ) -> KeyframeId {
        let keyframe = map.add_keyframe(frame, pose);
        map.keyframe_mut(keyframe).odometry = odometry;
        for (feature, landmark) in tracked.iter().enumerate().filter_map(|(i, l)| Some((i, (*l)?))) {
            map.observe(landmark, keyframe, feature);
        }
        map.add_to_spanning_tree(keyframe);
        let mut new = self.add_landmarks(map, keyframe);
        new.extend(triangulate_new(map, keyframe, self.model, self.thresholds));
        self.fuse(map, keyframe, &new);
        for id in map.keyframe(keyframe).landmarks.clone().into_iter().flatten() {
            map.refresh(id, self.model);
        }
        store_reference_patches(map, keyframe, self.model);
        self.cull(map, keyframe);
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
            let point = keyframe.frame.point(i, self.model)?;
            Some((i, keyframe.visual_from_camera.transform(point)))
        };
        let points: Vec<_> = (0..keyframe.frame.len()).filter(good).filter_map(place).collect();
        let mut new = Vec::with_capacity(points.len());
        for (feature, position) in points {
            let landmark = map.add_landmark(position);
            map.observe(landmark, id, feature);
            map.refresh(landmark, self.model);
            new.push(landmark);
        }
        new
    }

    /// Searches landmarks in the keyframes around the new one. A duplicate is merged with the older landmark.
    fn fuse(&self, map: &mut LandmarkMap, keyframe: KeyframeId, landmarks: &[LandmarkId]) {
        for (other, _) in
            map.covisible(keyframe, MIN_SHARED_LANDMARKS).into_iter().take(self.config.fused_keyframes)
        {
            self.fuse_into(map, other, landmarks);
        }
    }

    /// Searches landmarks in a keyframe and in those around it.
    pub fn fuse_around(&self, map: &mut LandmarkMap, keyframe: KeyframeId, landmarks: &[LandmarkId]) {
        let around = map.covisible(keyframe, MIN_SHARED_LANDMARKS).into_iter().map(|(id, _)| id);
        let targets: Vec<KeyframeId> =
            [keyframe].into_iter().chain(around.take(self.config.fused_keyframes)).collect();
        for target in targets {
            self.fuse_into(map, target, landmarks);
        }
    }

    /// Searches landmarks in a keyframe. If the feature has a landmark already, the older of the two stays.
    fn fuse_into(&self, map: &mut LandmarkMap, keyframe: KeyframeId, landmarks: &[LandmarkId]) {
        for (feature, landmark) in self.find(map, keyframe, landmarks) {
            match map.keyframe(keyframe).landmarks[feature] {
                Some(other) => map.merge(other.min(landmark), other.max(landmark)),
                None => _ = map.observe(landmark, keyframe, feature),
            }
        }
    }

    /// Features of a keyframe that show these landmarks, by descriptor, window and reprojection at 95 %.
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
            let seen = Projection::of(landmark, camera_from_visual, self.model, self.window_px);
            let Some((projection, p_camera)) = seen else { continue };
            projections.push(projection);
            sought.push((id, p_camera));
        }
        let agrees = |(feature, i): (usize, usize)| {
            let (id, p_camera) = sought[i];
            let seen = other.frame.unaligned_observation(feature, self.model);
            (seen.chi2(&self.model.camera, p_camera) <= seen.chi2_bound()).then_some((feature, id))
        };
        let all = vec![true; other.frame.len()];
        search(&other.frame, &all, &projections, self.thresholds).into_iter().filter_map(agrees).collect()
    }

    /// Removes landmarks without a second observation at the end of their trial, and those that frames seldom find. Checks the landmarks of
    /// the keyframes around the new one, and of the keyframe whose trial ends.
    fn cull(&self, map: &mut LandmarkMap, new: KeyframeId) {
        let LocalMappingConfig { trial_keyframes, trial_frames, found_ratio, .. } = *self.config;
        let Some(oldest_on_trial) = map.keyframe_ids().rev().nth(trial_keyframes) else { return };
        let judged = map.keyframe_ids().rev().nth(trial_keyframes + 1);
        let alone = |l: &Landmark| l.observations.len() == 1 && l.observations[0].0 < oldest_on_trial;
        let seldom = |l: &Landmark| {
            l.visible >= trial_frames && f64::from(l.found) < found_ratio * f64::from(l.visible)
        };
        let is_gone = |id: LandmarkId| map.landmark(id).is_some_and(|l| alone(l) || seldom(l));
        let near = keyframes_around(map, map.keyframe(new).visual_from_camera);
        let seen = |id: KeyframeId| map.keyframe(id).landmarks.iter().flatten().copied();
        let gone: Vec<LandmarkId> =
            near.into_iter().chain(judged).flat_map(seen).filter(|id| is_gone(*id)).collect();
        gone.into_iter().for_each(|id| map.forget(id));
    }
}
