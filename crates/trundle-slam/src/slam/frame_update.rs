//! Updates of state and map by a frame, located or not.

use super::RgbdSlam;
use super::localizer::Localization;
use super::map_start::{MapStart, MapStartQuery, Visibility};
use crate::atlas::map_merger::{MapMerger, Merged};
use crate::atlas::trajectory::FrameRecord;
use crate::frame::rgbd_frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::local_mapping::keyframe_culling::cull_keyframes;
use crate::local_mapping::local_mapper::LocalMapper;
use crate::map::anchored_pose::AnchoredPose;
use crate::map::landmark_map::LandmarkMap;
use crate::motion::uncertain_pose::{UncertainPose, propagated};
use crate::report::{MapMerge, Mode, SeenFeature, TrackReport};
use crate::tracking::last_frame::LastFrame;
use crate::tracking::local_map::LocalMapQuery;
use crate::tracking::localized_frame::LocalizedFrame;
use crate::tracking::tracking_state::TrackingState;
use crate::tracking::tracking_status::Tracking;
use nalgebra::Matrix6;
use trundle_core::{CameraMotion, DepthImage, Pose3, Stamp};

/// A frame that became a keyframe.
struct InsertedKeyframe {
    id: KeyframeId,
    merged: Option<MapMerge>,
}

impl RgbdSlam {
    /// Applies a found pose: counts landmarks, and makes a keyframe if wanted.
    pub(super) fn on_located(&mut self, frame: Frame, found: Localization) -> TrackReport {
        let Localization { map, localized } = found;
        let is_continuous = self.tracking.lost_frames == 0 && map == self.atlas.active.id;
        let last = self.tracking.last.as_ref().filter(|_| is_continuous);
        let before = last.map(|last| last.anchored.visual_from_camera(&self.atlas.active.map));
        if self.atlas.enter(map) {
            self.tracking.last = None;
            self.loops.drop_pending();
            self.leave_keyframe();
        }
        self.odometry.set_doubted(localized.contradicts_odometry());
        if localized.recognized.is_some() || self.tracking.odometry_conflict.persists(frame.stamp) {
            // The wheels slipped, or the robot was carried.
            self.odometry.interrupt();
        }
        let mut landmarks = localized.landmarks(frame.len());
        let frame = frame.with_aligned(localized.aligned_features(), &self.front_end.model);
        record_features(&mut self.features, &frame, &landmarks);
        let mut pose = localized.pose.visual_from_camera();
        let mut reference = reference_keyframe(&self.atlas.active.map, &self.tracking, &landmarks);
        let mut covariance = self.pose_covariance(&localized, reference);
        let inserted = self.update_map(&frame, &localized, &landmarks, covariance);
        if let Some(inserted) = &inserted {
            reference = inserted.id;
            let keyframe = self.atlas.active.map.keyframe(reference);
            covariance = keyframe.covariance;
            (pose, landmarks) = (keyframe.visual_from_camera, keyframe.landmarks.clone());
        }
        let is_one_frame = inserted.as_ref().is_none_or(|inserted| inserted.merged.is_none());
        self.tracking.belief.located(frame.stamp, pose, covariance, before.filter(|_| is_one_frame));
        self.tracking.pose_known = true;
        self.tracking.end_lost_run();
        let tracking = localized.tracking(&self.config.tracking);
        let anchored = self.record_pose(frame.stamp, Some(reference), tracking);
        let report = TrackReport {
            matches: localized.matches,
            inliers: localized.points,
            relocalised: localized.recognized.is_some(),
            new_keyframe: inserted.is_some(),
            merged: inserted.and_then(|inserted| inserted.merged),
            ..self.report(frame.len())
        };
        self.set_last(LastFrame { frame, landmarks, anchored });
        report
    }

    /// Continues without a located frame; begins a map at the predicted pose if no known landmark will be seen again.
    pub(super) fn on_lost(
        &mut self,
        frame: Frame,
        depth: &DepthImage,
        prior: Option<CameraMotion>,
    ) -> TrackReport {
        let tracking = &mut self.tracking;
        tracking.belief.missed(frame.stamp, prior, &self.config.motion);
        tracking.lost_frames += 1;
        tracking.motion_unknown |= prior.is_none();
        record_features(&mut self.features, &frame, &vec![None; frame.len()]);
        let start = self.map_start(&frame, depth, prior.is_some());
        if start == MapStart::NewMap {
            self.start_new_map();
        }
        let keyframe = (start != MapStart::Wait).then(|| self.start_map(&frame, start));
        let tracking = match start {
            MapStart::FirstMap | MapStart::NewMap => Tracking::Ok,
            _ if prior.is_some() && self.tracking.pose_known => Tracking::DeadReckoning,
            _ => Tracking::Lost,
        };
        let known = || self.tracking.last.as_ref().and_then(|last| last.anchored.reference);
        let anchored = self.record_pose(frame.stamp, keyframe.or_else(known), tracking);
        let report = TrackReport { new_keyframe: keyframe.is_some(), ..self.report(frame.len()) };
        if let Some(id) = keyframe {
            let landmarks = self.atlas.active.map.keyframe(id).landmarks.clone();
            self.set_last(LastFrame { frame, landmarks, anchored });
            self.tracking.end_lost_run();
            self.tracking.pending_relocalisations = Default::default();
        } else {
            self.tracking.lost_frame = Some(frame);
        }
        report
    }

    /// Decides whether a frame that was not located begins a map, and whether the view changed abruptly.
    fn map_start(&mut self, frame: &Frame, depth: &DepthImage, has_prior: bool) -> MapStart {
        let Self { config, front_end, atlas, tracking, mode, .. } = self;
        let query = LocalMapQuery::new(&front_end.model, (depth, &config.depth), &config.tracking);
        let map = &atlas.active.map;
        let expected = || query.landmarks(map, tracking.belief.visual_from_camera).len();
        let visibility = Visibility { frame, expected: &expected };
        let is_discontinuous = visibility.is_discontinuous(tracking);
        tracking.view_discontinuity |= is_discontinuous;
        if *mode == Mode::Localisation {
            return MapStart::Wait;
        }
        let expected = || query.landmarks(map, tracking.belief.visual_from_camera).len();
        let visibility = Visibility { frame, expected: &expected };
        MapStartQuery { visibility, config, map, tracking, has_prior }.decide()
    }

    /// Drops the data of the newest keyframes, when they are of another map or far away.
    pub(super) fn leave_keyframe(&mut self) {
        self.loops.drop_searches();
        self.odometry.interrupt();
        self.tracking.odometry_conflict = Default::default();
    }

    /// Covariance of a found pose: that of the pose relative to the points, plus that of the points. Points of the map have the covariance
    /// of the reference keyframe. If the last frame alone gives the pose, its points have the covariance of the last pose, which then grows
    /// from frame to frame.
    fn pose_covariance(&self, localized: &LocalizedFrame, reference: KeyframeId) -> Matrix6<f64> {
        let pose = localized.pose.visual_from_camera();
        let local = localized.pose.solution.covariance.unwrap_or_else(Matrix6::identity);
        let belief = &self.tracking.belief;
        let (anchor, covariance) = if localized.by_map {
            let keyframe = self.atlas.active.map.keyframe(reference);
            (keyframe.visual_from_camera, &keyframe.map_covariance)
        } else {
            (belief.visual_from_camera, &belief.covariance)
        };
        propagated(covariance, anchor.inverse() * pose) + local
    }

    /// Updates the map by a located frame, unless the map is fixed.
    fn update_map(
        &mut self,
        frame: &Frame,
        localized: &LocalizedFrame,
        landmarks: &[Option<LandmarkId>],
        covariance: Matrix6<f64>,
    ) -> Option<InsertedKeyframe> {
        if self.mode == Mode::Localisation {
            return None;
        }
        let map = &mut self.atlas.active.map;
        map.count_observations(localized.findable(), landmarks);
        let pose = localized.pose.visual_from_camera();
        let tracked = landmarks.iter().flatten().count();
        let shown = localized.visible.iter().map(|(_, projection)| projection.pixel);
        let is_wanted = self.config.keyframes.needs_keyframe(frame, pose, tracked, shown, map);
        is_wanted.then(|| self.add_keyframe(frame, pose, landmarks, covariance))
    }

    fn add_keyframe(
        &mut self,
        frame: &Frame,
        pose: Pose3,
        landmarks: &[Option<LandmarkId>],
        covariance: Matrix6<f64>,
    ) -> InsertedKeyframe {
        let id = self.insert(frame.clone(), pose, landmarks);
        self.atlas.active.map.set_covariance(id, covariance);
        self.loops.push(id);
        let merged = self.merge_maps(id);
        InsertedKeyframe { id: merged.map_or(id, |merged| merged.keyframe), merged }
    }

    /// Merges the active map with another one that the keyframe shows.
    fn merge_maps(&mut self, keyframe: KeyframeId) -> Option<MapMerge> {
        let merger = MapMerger {
            mapper: LocalMapper::new(&self.front_end.model, &self.config.mapping, &self.config.tracking),
            config: &self.config.loops,
            tracking: &self.config.tracking,
            seed: self.trajectory.seed(self.config.seed),
        };
        let Merged { report, absorbed, ids, into_from_absorbed } = merger.merge(&mut self.atlas, keyframe)?;
        self.leave_keyframe();
        self.trajectory.move_into(report.into, &absorbed, &ids, into_from_absorbed);
        Some(report)
    }

    fn insert(&mut self, frame: Frame, pose: Pose3, tracked: &[Option<LandmarkId>]) -> KeyframeId {
        let Self { config, front_end, atlas, odometry, .. } = self;
        let (model, active) = (&front_end.model, &mut atlas.active);
        odometry.update_floor(&mut active.map);
        let factor = odometry.factor_in(&active.map);
        let mapper = LocalMapper::new(model, &config.mapping, &config.tracking);
        let keyframe = mapper.insert(&mut active.map, frame, pose, (tracked, factor));
        active.optimisation.begin_around(&mut active.map, keyframe, model, &config.mapping);
        odometry.start_at(keyframe);
        cull_keyframes(&mut active.map, keyframe, &config.keyframes);
        active.update_index();
        keyframe
    }

    /// Leaves the active map for an empty one, whose origin is the camera.
    fn start_new_map(&mut self) {
        let belief = &self.tracking.belief;
        let measured = UncertainPose { pose: belief.visual_from_camera, covariance: belief.covariance };
        if let Some(dropped) = self.atlas.start_new_map((!self.tracking.is_lost()).then_some(measured)) {
            self.trajectory.fix_poses(&dropped);
        }
        self.tracking.restart_at(Pose3::identity());
        self.loops.drop_pending();
        self.leave_keyframe();
    }

    /// Adds the first keyframe of the active map, or a keyframe that continues the map by odometry.
    fn start_map(&mut self, frame: &Frame, start: MapStart) -> KeyframeId {
        if start != MapStart::Continue {
            self.tracking.belief.covariance = Matrix6::zeros();
        }
        let (pose, covariance) = (self.tracking.belief.visual_from_camera, self.tracking.belief.covariance);
        let id = self.insert(frame.clone(), pose, &vec![None; frame.len()]);
        self.atlas.active.map.set_covariance(id, covariance);
        id
    }

    /// Sets the last located frame; the previous one leaves its buffers for the next features.
    fn set_last(&mut self, located: LastFrame) {
        if let Some(before) = self.tracking.last.replace(located) {
            self.front_end.reuse(before.frame);
        }
    }

    fn record_pose(
        &mut self,
        stamp: Stamp,
        reference: Option<KeyframeId>,
        tracking: Tracking,
    ) -> AnchoredPose {
        let (pose, active) = (self.tracking.belief.visual_from_camera, &self.atlas.active);
        let anchored = AnchoredPose::new(stamp, reference, pose, &active.map);
        self.trajectory.record(FrameRecord { anchored, map: active.id, tracking });
        anchored
    }

    /// The report of the last frame, with the number of its features.
    fn report(&self, features: usize) -> TrackReport {
        let record = self.trajectory.last().expect("invariant: the frame was recorded");
        TrackReport {
            stamp: record.anchored.stamp,
            tracking: record.tracking,
            map: record.map,
            visual_from_camera: self.tracking.belief.visual_from_camera,
            covariance: self.tracking.belief.covariance,
            features,
            matches: 0,
            inliers: 0,
            relocalised: false,
            new_keyframe: false,
            closed_loop: self.corrections.closed_loop,
            merged: None,
            refined: self.corrections.refined,
            keyframes: self.atlas.active.map.keyframe_count(),
            landmarks: self.atlas.active.map.landmark_count(),
        }
    }
}

/// The keyframe with the largest number of common landmarks with the frame; without any, the last frame's reference.
fn reference_keyframe(
    map: &LandmarkMap,
    tracking: &TrackingState,
    landmarks: &[Option<LandmarkId>],
) -> KeyframeId {
    let seeing = map.keyframes_seeing(landmarks.iter().flatten().copied());
    let last = || Some(map.resolve(tracking.last.as_ref()?.anchored.reference?).0);
    let newest =
        || map.newest_keyframe().expect("invariant: a frame is tracked only in a map with keyframes");
    seeing.first().map(|(id, _)| *id).or_else(last).unwrap_or_else(newest)
}

fn record_features(features: &mut Vec<SeenFeature>, frame: &Frame, landmarks: &[Option<LandmarkId>]) {
    features.clear();
    let keypoints = frame.features.keypoints.iter().zip(landmarks);
    features.extend(keypoints.map(|(k, l)| SeenFeature { keypoint: *k, tracked: l.is_some() }));
}
