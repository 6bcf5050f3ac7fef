//! The entry point: one image in, the camera's pose out.

mod frame_update;
mod localizer;
mod map_start;

use crate::atlas::map_collection::Atlas;
use crate::atlas::trajectory::Trajectory;
use crate::calibration_check::check::CalibrationCheck;
use crate::calibration_check::issue::CalibrationIssue;
use crate::config::SlamConfig;
use crate::frame::front_end::FrontEnd;
use crate::ids::{KeyframeId, MapId};
use crate::loop_closing::loop_closer::LoopCloser;
use crate::loop_closing::loop_closure::LoopClosure;
use crate::loop_closing::loop_detector::{LoopDetector, LoopStep};
use crate::map::odometry_track::OdometryTrack;
use crate::motion::motion_limits::MotionLimits;
use crate::persist::error::MapFileError;
use crate::persist::map_file;
use crate::report::{FramePose, Mode, SeenFeature, TrackReport};
use crate::tracking::tracking_state::TrackingState;
use localizer::Localizer;
use std::sync::Arc;
use trundle_core::{CameraMotion, DepthImage, Invalid, PinholeCamera, Pose3, RgbdImage, Stamp, Vector3};
use trundle_vision::{Features, Vocabulary};

/// Tolerance of a motion prior besides the largest speeds: 0.2 m and 0.2 rad. A larger prior is an odometry that jumped, and is dropped.
/// Source: ours.
const MAX_INSTANT_PRIOR: f64 = 0.2;

/// RGB-D SLAM: one image in, the camera's pose out; keeps the landmark map. See the crate's documentation.
///
/// Synchronous and deterministic: the same images, priors and configuration give the same bits.
#[derive(Debug)]
pub struct RgbdSlam {
    config: SlamConfig,
    mode: Mode,
    front_end: FrontEnd,
    atlas: Atlas,
    tracking: TrackingState,
    odometry: OdometryTrack,
    loops: LoopDetector,
    trajectory: Trajectory,
    /// Motion of the camera by corrections of the map between the last frame and the present one.
    corrections: MapCorrections,
    /// The features of the last image.
    features: Vec<SeenFeature>,
    calibration: CalibrationCheck,
}

/// Corrections of the camera's pose by the map between two frames.
#[derive(Debug, Clone, Copy, Default)]
struct MapCorrections {
    /// `new_from_old` by bundle adjustment.
    refined: Option<Pose3>,
    closed_loop: Option<LoopClosure>,
}

impl RgbdSlam {
    /// An empty map for images of this camera. The first keyframe is at the identity.
    ///
    /// A rolling shutter is part of the camera: see [`PinholeCamera::with_readout`].
    ///
    /// # Errors
    /// When the configuration is invalid.
    pub fn new(camera: PinholeCamera, config: SlamConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let camera = config.motion.with_readout_of(camera)?;
        let front_end = FrontEnd::new(camera, &config)?;
        Ok(Self {
            mode: Mode::default(),
            front_end,
            atlas: Atlas::new(&Vocabulary::builtin()),
            tracking: TrackingState::at(Pose3::identity()),
            odometry: OdometryTrack::default(),
            loops: LoopDetector::default(),
            trajectory: Trajectory::new(config.kept_frames),
            corrections: MapCorrections::default(),
            features: vec![],
            calibration: CalibrationCheck::default(),
            config,
        })
    }

    /// This tracker with another vocabulary than the built-in one; call it before the first image.
    #[must_use]
    pub fn with_vocabulary(mut self, vocabulary: &Arc<Vocabulary>) -> Self {
        self.set_vocabulary(vocabulary);
        self
    }

    /// Sets the vocabulary of place recognition, also for existing keyframes.
    pub fn set_vocabulary(&mut self, vocabulary: &Arc<Vocabulary>) {
        self.atlas.set_vocabulary(vocabulary);
    }

    /// This tracker with the camera at `visual_from_camera` at the start; call it before the first image. In a loaded map, the search for
    /// the camera starts there.
    #[must_use]
    pub fn starting_at(mut self, visual_from_camera: Pose3) -> Self {
        self.tracking.start_at(visual_from_camera);
        self
    }

    /// Declares the pose unknown, when the robot was carried away. The camera counts as lost, even with odometry, until a place is
    /// recognized.
    pub fn kidnapped(&mut self) {
        self.tracking.forget_pose();
        self.leave_keyframe();
    }

    /// Sets mapping or localization in fixed maps.
    pub fn set_mode(&mut self, mode: Mode) {
        self.mode = mode;
    }

    /// Whether the maps change.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Localizes one image. `prior` is the motion since the previous image, `previous_camera_from_camera`, by wheels and gyro. Without a
    /// prior, or with an impossibly fast one, the camera is predicted at constant velocity. An empty image, or one of a wrong size, counts
    /// as an image without features and is not located.
    pub fn step(&mut self, image: &RgbdImage, prior: Option<CameraMotion>) -> TrackReport {
        let (gray, depth) = self.front_end.reduced(image);
        let features = self.front_end.extract(&gray);
        self.calibration.record_image(&gray, &depth);
        self.step_with_features(image.stamp(), features, &depth, prior)
    }

    /// A step with given features, from an extractor of the same configuration in another thread, for example. Images larger than
    /// `max_side_px` are given in their reduced size.
    pub fn step_with_features(
        &mut self,
        stamp: Stamp,
        features: Features,
        depth: &DepthImage,
        prior: Option<CameraMotion>,
    ) -> TrackReport {
        let belief = &self.tracking.belief;
        let seconds = belief.seconds_until(stamp);
        let is_possible = |prior: &CameraMotion| {
            prior.is_finite() && MotionLimits::PRIOR.allow(prior.motion, MAX_INSTANT_PRIOR, seconds)
        };
        let prior = prior.filter(is_possible);
        let motion = prior.map(|prior| prior.motion);
        let turn_rate = belief.turn_rate(stamp, motion);
        let frame = self.front_end.frame(stamp, features, depth, turn_rate, &self.config.depth);
        self.calibration.record_frame(&frame, depth, motion, &self.front_end.model, &self.config.depth);
        self.odometry.extend(prior, seconds, &self.config.motion);
        self.update_map_between_frames(self.config.mapping.work_per_frame);
        let localizer = Localizer {
            atlas: &self.atlas,
            model: &self.front_end.model,
            config: &self.config,
            odometry: self.odometry.since_keyframe,
            frame: &frame,
            depth,
            frame_number: self.trajectory.frame_count(),
            are_maps_fixed: self.mode == Mode::Localisation,
        };
        match localizer.localize(&mut self.tracking, motion) {
            Some(localized) => self.on_located(frame, localized),
            None => self.on_lost(frame, depth, prior),
        }
    }

    /// Completes the refinement of the map, which `step` does in slices between frames. Call it before the map is saved, or while the
    /// camera is at rest.
    pub fn finish_refining(&mut self) {
        let is_due = |slam: &Self| {
            !slam.loops.is_idle() || slam.atlas.active.optimisation.is_pending(&slam.atlas.active.map)
        };
        while self.mode == Mode::Mapping && is_due(self) {
            self.update_map_between_frames(usize::MAX);
        }
    }

    /// Continues the search for loops; without one, the bundle adjustment.
    fn update_map_between_frames(&mut self, work: usize) {
        self.corrections = MapCorrections::default();
        if self.mode == Mode::Localisation || self.detect_loops() {
            return;
        }
        let active = &mut self.atlas.active;
        let (model, mapping) = (&self.front_end.model, &self.config.mapping);
        if active.optimisation.advance(&mut active.map, model, mapping, work) {
            self.corrections.refined = self.move_with_map();
        }
    }

    /// Continues the search for loops. Returns whether there was work. A closed loop moves the camera along with the map.
    fn detect_loops(&mut self) -> bool {
        let seed = self.trajectory.seed(self.config.seed);
        let active = &mut self.atlas.active;
        let loop_closer = LoopCloser {
            place_index: &active.place_index,
            model: &self.front_end.model,
            config: &self.config.loops,
            tracking: &self.config.tracking,
            mapping: &self.config.mapping,
            seed,
        };
        match self.loops.advance(&loop_closer, &mut active.map, &mut active.optimisation) {
            LoopStep::Idle => return false,
            LoopStep::Searched => {}
            LoopStep::Closed(closure) => {
                active.update_index();
                let correction = self.move_with_map().unwrap_or(closure.correction);
                self.corrections.closed_loop = Some(LoopClosure { correction, ..closure });
            }
        }
        true
    }

    /// Moves the camera with a changed map; returns `new_from_old` of its pose in the visual frame.
    fn move_with_map(&mut self) -> Option<Pose3> {
        let active = &self.atlas.active;
        let last = self.trajectory.last().filter(|record| record.map == active.id)?;
        let pose = last.anchored.visual_from_camera(&active.map);
        let correction = pose * self.tracking.belief.visual_from_camera.inverse();
        self.tracking.belief.visual_from_camera = pose;
        Some(correction)
    }

    /// Poses of the active map's frames that were not lost, in the order of `step`: `visual_from_camera` by the present map. At most the
    /// newest [`SlamConfig::kept_frames`] frames, without dropped ones.
    pub fn trajectory(&self) -> Vec<(Stamp, Pose3)> {
        self.trajectory.poses(&self.atlas.active)
    }

    /// All frames in the order of `step`, by the present maps, including those of inactive maps (in the frame of their own map) and those
    /// not located. At most the newest [`SlamConfig::kept_frames`] frames, without dropped ones.
    pub fn frames(&self) -> Vec<FramePose> {
        self.trajectory.frames(&self.atlas)
    }

    /// Drops the poses of all frames except the last one and those `wanted`, to bound memory: an hour has a hundred thousand frames.
    pub fn forget_frames(&mut self, wanted: impl Fn(Stamp) -> bool) {
        self.trajectory.retain(wanted);
    }

    /// All landmarks of the active map, visual frame, m, in the order of creation.
    pub fn landmarks(&self) -> impl Iterator<Item = Vector3> + '_ {
        self.atlas.active.map.landmarks().map(|(_, landmark)| landmark.position)
    }

    /// Keyframes of the active map: id, time and `visual_from_camera`, in the order of creation.
    pub fn keyframes(&self) -> impl Iterator<Item = (KeyframeId, Stamp, Pose3)> + '_ {
        self.atlas.active.map.keyframes().map(|(id, k)| (id, k.frame.stamp, k.visual_from_camera))
    }

    /// The covisibility graph of the active map: pairs of keyframes that share at least `min_shared` landmarks, the older first, with the
    /// number of common landmarks \[MurArtal17\].
    pub fn covisibility(&self, min_shared: usize) -> Vec<(KeyframeId, KeyframeId, usize)> {
        let map = &self.atlas.active.map;
        let older = |id: KeyframeId| {
            let shared = map.covisible(id, min_shared.max(1)).into_iter();
            shared.filter(move |(other, _)| *other < id).map(move |(other, shared)| (other, id, shared))
        };
        map.keyframes().flat_map(|(id, _)| older(id)).collect()
    }

    /// The loops closed in the active map: the old and the new keyframe of each.
    pub fn loops(&self) -> Vec<(KeyframeId, KeyframeId)> {
        self.atlas.active.map.loops().collect()
    }

    /// All maps, by rising id; several after the camera was lost, until a merge.
    pub fn maps(&self) -> Vec<MapId> {
        self.atlas.maps().into_iter().map(|map| map.id).collect()
    }

    /// The features of the last image, with their positions in that image.
    pub fn last_features(&self) -> Vec<SeenFeature> {
        self.features.iter().map(|feature| feature.enlarged(self.front_end.reduction)).collect()
    }

    /// Settings that are probably wrong, by the first images.
    pub fn calibration_issues(&self) -> Vec<CalibrationIssue> {
        let factor = self.front_end.reduction.factor() as f64;
        self.calibration.issues().iter().map(|issue| issue.enlarged(factor)).collect()
    }

    /// All maps as bytes: versioned, with a checksum and the settings of their features. The trajectory is not included.
    ///
    /// The same maps give the same bytes, before and after [`RgbdSlam::load`].
    pub fn save(&self) -> Vec<u8> {
        let mut maps = self.atlas.maps();
        maps.retain(|map| map.map.keyframe_count() > 0);
        let maps = maps.into_iter().map(|map| (map.id, &map.map));
        map_file::save(&self.front_end.model.camera, &self.config, maps)
    }

    /// Continues with saved maps. The camera counts as lost, even with odometry, until a place is recognized or [`RgbdSlam::starting_at`]
    /// gives its pose.
    ///
    /// # Errors
    /// When the configuration is invalid, or the bytes are not a map, of another version, damaged, cut off, made with another camera or
    /// other features, or inconsistent. No input causes a panic.
    pub fn load(bytes: &[u8], camera: PinholeCamera, config: SlamConfig) -> Result<Self, MapFileError> {
        let mut slam = Self::new(camera, config)?;
        let maps = map_file::load(bytes, &slam.front_end.model, &slam.config)?;
        if slam.atlas.replace(maps) {
            slam.kidnapped();
        }
        Ok(slam)
    }
}
