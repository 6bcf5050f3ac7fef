//! The fixed-lag smoother: inputs and estimate.

use super::calibration::{SmootherCalibration, WithSigma};
use super::config::{SmootherConfig, WindowConfig};
use super::error_process::{ErrorStart, ErrorStep};
use super::keyframe::Keyframe;
use super::motion_buffer::MotionBuffer;
use super::prediction::{Predicted, pose_after};
use super::preintegration::{Preintegrated, parameters};
use super::prior::{Prior, PriorSigmas};
use super::state::{BIAS_PLACE, BorderState, CHAIN_SIZE, ChainState, DELAY_PLACE, SCALE_PLACE, WHEELS_PLACE};
use super::visual_maps::{StoredAnchor, VisualMaps};
use super::window::Window;
use crate::fusion::visual_frame::VisualAnchor;
use crate::odometry::motion_increment::MotionIncrement;
use crate::odometry_config::OdometryConfig;
use nalgebra::{Matrix3, Vector2, Vector3};
use std::collections::BTreeMap;
use trundle_core::{DifferentialDrive, Invalid, Pose2, Pose3, PoseEstimate, Stamp, Twist2};

/// The fixed-lag smoother; see the documentation of its module.
#[derive(Debug, Clone)]
pub struct Smoother {
    pub(super) config: SmootherConfig,
    pub(super) base_from_camera: Pose3,
    pub(super) motions: MotionBuffer,
    pub(super) maps: VisualMaps,
    pub(super) window: Option<Window>,
    /// Covariance of the pose at the first motion.
    pub(super) start: Matrix3<f64>,
    /// Motion since the newest keyframe.
    pub(super) head: Preintegrated,
    /// Estimate of the newest keyframe.
    pub(super) newest: Option<Predicted>,
    pub(super) twist: Twist2,
    /// Number of measurements after which the window had no solution.
    pub(super) failures: usize,
}

/// Variances of an unknown pose, m^2, m^2, rad^2. Source: as in [`crate::Localizer`].
const UNKNOWN_POSE_VARIANCES: Vector3<f64> = Vector3::new(1e4, 1e4, 10.0);
/// Distance (m) between two keyframes below which the robot is at rest. Source: ours: ten ticks of a Kobuki.
const REST_DISTANCE_M: f64 = 1e-3;
/// Turn (rad) below which a robot is at rest between two keyframes. Source: ours.
const REST_TURN_RAD: f64 = 4e-3;
/// Factor on the time between keyframes at rest. Source: ours.
const REST_TIME_FACTOR: f64 = 4.0;

impl Smoother {
    /// A smoother at the map's origin, for this drive and a camera mounted at `base_from_camera`.
    ///
    /// # Errors
    /// When a configuration is out of range or the mount is not finite.
    pub fn new(
        config: SmootherConfig,
        odometry: OdometryConfig,
        drive: DifferentialDrive,
        base_from_camera: Pose3,
    ) -> Result<Self, Invalid> {
        let (config, odometry, drive) = (config.validated()?, odometry.validated()?, drive.validated()?);
        if !base_from_camera.is_finite() {
            return Err(Invalid::new("base_from_camera", "not finite", "", "finite numbers"));
        }
        Ok(Self {
            config,
            base_from_camera,
            motions: MotionBuffer::new(drive, odometry),
            maps: VisualMaps::default(),
            window: None,
            start: Matrix3::zeros(),
            head: Preintegrated::new(parameters(0.0, &BorderState::default())),
            newest: None,
            twist: Twist2::ZERO,
            failures: 0,
        })
    }

    /// The smoother of a resumed run in a known map: the poses of the visual maps (by number) are known, the robot's pose is unknown.
    #[must_use]
    pub fn resumed(mut self, visual_maps: &BTreeMap<u32, VisualAnchor>) -> Self {
        self.start = Matrix3::from_diagonal(&UNKNOWN_POSE_VARIANCES);
        let stored = |anchor: &VisualAnchor| StoredAnchor {
            level_from_visual: anchor.map_from_visual,
            anchor: Pose2::IDENTITY,
            covariance: anchor.covariance.into(),
        };
        self.maps = VisualMaps::with_anchors(
            visual_maps.iter().map(|(map, anchor)| (*map, stored(anchor))).collect(),
        );
        self
    }

    /// Adds the motion of one reading of the wheels. Invalid or old motion is dropped (`false`).
    pub fn add_motion(&mut self, increment: &MotionIncrement) -> bool {
        if !is_usable(increment)
            || self.motions.newest().is_some_and(|newest| increment.stamp <= newest.stamp)
        {
            return false;
        }
        if self.window.is_none() {
            self.begin(increment.stamp.after(-increment.dt));
        }
        self.motions.push(*increment);
        let before = self.head.motion;
        self.motions.extend(&mut self.head, increment);
        let moved = (before.inverse() * self.head.motion).log() / increment.dt;
        self.twist = Twist2::new(moved.x, moved.z);
        self.add_timed_keyframe(increment.stamp);
        true
    }

    /// The estimate at the stamp of the newest motion. Without motion: the origin at time 0.
    pub fn estimate(&self) -> PoseEstimate {
        let (Some(window), Some(newest)) = (&self.window, &self.newest) else {
            let (pose, stamp) = (Pose2::IDENTITY, Stamp::default());
            return PoseEstimate { stamp, pose, twist: Twist2::ZERO, covariance: self.start };
        };
        let (pose, covariance) = pose_after(newest, &self.head, &window.border);
        let stamp = self.motions.newest().map_or(window.newest().stamp, |motion| motion.stamp);
        PoseEstimate { stamp, pose, twist: self.twist, covariance }
    }

    /// The calibration; `None` without motion.
    pub fn calibration(&self) -> Option<SmootherCalibration> {
        let (window, newest) = (self.window.as_ref()?, self.newest.as_ref()?);
        let sigma = |place: usize| newest.covariance[(place, place)].max(0.0).sqrt();
        let common = |place: usize, value: f64| WithSigma { value, sigma: sigma(CHAIN_SIZE + place) };
        let border = &window.border;
        Some(SmootherCalibration {
            gyro_bias: WithSigma { value: newest.state.bias, sigma: sigma(BIAS_PLACE) },
            gyro_scale: common(SCALE_PLACE, border.scale),
            left_radius: common(WHEELS_PLACE, border.wheels.x),
            right_radius: common(WHEELS_PLACE + 1, border.wheels.y),
            wheelbase: common(WHEELS_PLACE + 2, border.wheels.z),
            camera_delay: common(DELAY_PLACE, border.delay),
        })
    }

    /// The recognised places of the window: stamp, and probability that the place is right.
    pub fn places(&self) -> impl Iterator<Item = (Stamp, f64)> + '_ {
        let keyframes = self.window.iter().flat_map(|window| &window.keyframes);
        keyframes.filter_map(|keyframe| match keyframe.error.start {
            Some(ErrorStart::Place(switch)) => Some((keyframe.stamp, switch.weight)),
            _ => None,
        })
    }

    /// Stamps and poses of the keyframes of the window, oldest first.
    pub fn keyframes(&self) -> impl Iterator<Item = (Stamp, Pose2)> + '_ {
        let keyframes = self.window.iter().flat_map(|window| &window.keyframes);
        keyframes.map(|keyframe| (keyframe.stamp, keyframe.state.pose))
    }

    /// The newest visual map's frame in the map; `None` without a visual pose.
    pub fn map_from_visual(&self) -> Option<Pose3> {
        let (_, slot) = self.maps.newest()?;
        let anchor = self.window.as_ref()?.border.anchors[slot];
        Some(Pose3::from_pose2(anchor) * self.maps.level(slot)?)
    }

    /// Number of times that the normal equations of the window were solved: the work of the smoother.
    pub fn solutions(&self) -> usize {
        self.window.as_ref().map_or(0, |window| window.solutions)
    }

    /// Number of measurements after which the window had no solution and the measurement was dropped.
    pub fn failures(&self) -> usize {
        self.failures
    }

    /// Declares the pose unknown, as after a kidnapping. The calibration is preserved, measurements are discarded.
    pub fn set_pose_unknown(&mut self) {
        let (Some(window), Some(newest)) = (&self.window, &self.newest) else { return };
        let estimate = self.estimate();
        let border = window.border;
        let variance = |place: usize| newest.covariance[(place, place)].max(0.0).sqrt();
        let sigmas = PriorSigmas {
            pose: Matrix3::from_diagonal(&UNKNOWN_POSE_VARIANCES),
            bias: variance(BIAS_PLACE),
            scale: variance(CHAIN_SIZE + SCALE_PLACE),
            radius: variance(CHAIN_SIZE + WHEELS_PLACE),
            wheelbase: variance(CHAIN_SIZE + WHEELS_PLACE + 2),
            delay: variance(CHAIN_SIZE + DELAY_PLACE),
        };
        let state = ChainState { pose: estimate.pose, error: Vector3::zeros(), bias: newest.state.bias };
        self.maps = VisualMaps::default();
        self.restart(estimate.stamp, state, border, &sigmas);
    }

    /// Begins the window at a stamp.
    fn begin(&mut self, stamp: Stamp) {
        let odometry = self.motions.config();
        let sigmas = PriorSigmas {
            pose: self.start,
            bias: odometry.gyro_bias_sigma,
            scale: odometry.gyro_scale_sigma,
            radius: odometry.wheel_radius_sigma,
            wheelbase: self.config.noise.wheelbase_sigma,
            delay: self.config.noise.delay_sigma,
        };
        self.restart(stamp, ChainState::at(Pose2::IDENTITY), BorderState::default(), &sigmas);
    }

    fn restart(&mut self, stamp: Stamp, state: ChainState, border: BorderState, sigmas: &PriorSigmas) {
        let first = Keyframe {
            stamp,
            state,
            motion: Preintegrated::new(parameters(state.bias, &border)),
            error: self.error_step(Matrix3::zeros(), None, Vector2::zeros()),
            trust: 1.0,
            visual: None,
            scan: None,
        };
        let prior = Prior::new(state, border, sigmas);
        let (count, odometry) = (self.config.window.max_keyframes, self.motions.config());
        self.window = Some(Window::new(first, border, prior, count, odometry));
        self.motions.forget_before(stamp);
        self.refresh();
    }

    /// The step of the visual error to a keyframe, with the covariance of the map part at that keyframe.
    pub(super) fn error_step(
        &self,
        map_part: Matrix3<f64>,
        start: Option<ErrorStart>,
        displacement: Vector2<f64>,
    ) -> ErrorStep {
        let (position, heading) =
            (self.config.noise.visual_map_position, self.config.noise.visual_map_heading_deg.to_radians());
        let own =
            Matrix3::from_diagonal(&Vector3::new(position, position, heading).map(|sigma| sigma * sigma));
        let correlation = (self.config.noise.correlation_distance, self.config.noise.correlation_turn);
        ErrorStep { stationary: own + map_part, correlation, displacement, start }
    }

    /// Adds a keyframe without measurements after a long time without keyframes.
    fn add_timed_keyframe(&mut self, stamp: Stamp) {
        let Some(window) = &self.window else { return };
        if self.head.duration < longest_time(&self.config.window, &self.head) {
            return;
        }
        let last = window.keyframes.len() - 1;
        let keyframe = self.keyframe_after(window, last, stamp);
        self.insert(last, keyframe);
    }

    /// A keyframe without measurements at a stamp after keyframe `k`.
    pub(super) fn keyframe_after(&self, window: &Window, k: usize, stamp: Stamp) -> Keyframe {
        let before = &window.keyframes[k];
        let at = parameters(before.state.bias, &window.border);
        let motion = self.motions.between(before.stamp, stamp, at);
        let pose = before.state.pose * motion.corrected(&at);
        let error =
            ErrorStep { start: None, displacement: self.displacement(window, before, &pose), ..before.error };
        let (moved, _) = error.moved(&before.state.error, &motion, before.trust);
        let state = ChainState { pose, error: moved, bias: before.state.bias };
        Keyframe { stamp, state, motion, error, trust: before.trust, visual: None, scan: None }
    }

    /// Displacement of the visual pose, in the axes of the newest visual map, that the base's motion predicts.
    fn displacement(&self, window: &Window, before: &Keyframe, pose: &Pose2) -> Vector2<f64> {
        let Some((_, slot)) = self.maps.newest() else { return Vector2::zeros() };
        let moved = pose.position() - before.state.pose.position();
        let turn = before.state.error.z - window.border.anchors[slot].theta;
        Pose2::new(0.0, 0.0, turn).rotate(moved)
    }

    /// Inserts a keyframe with an image after keyframe `k` and solves the window. It replaces the newest keyframe if that one is near its
    /// predecessor, so that images with a common error count once.
    pub(super) fn insert_image(&mut self, k: usize, keyframe: Keyframe) {
        let Some(window) = &mut self.window else { return };
        let is_newest = k + 1 == window.keyframes.len();
        if is_newest
            && keyframe.error.start.is_none()
            && is_provisional(&self.config.window, &window.keyframes)
        {
            window.replace_newest(keyframe, &self.motions);
            self.solve();
        } else {
            self.insert(k, keyframe);
        }
    }

    /// Inserts a keyframe after keyframe `k` and solves the window.
    pub(super) fn insert(&mut self, k: usize, keyframe: Keyframe) {
        let Some(window) = &mut self.window else { return };
        window.insert_after(k, keyframe, &self.motions);
        self.solve();
    }

    /// Solves the window, evaluates its recognised places and removes keyframes that are too old.
    pub(super) fn solve(&mut self) {
        let Some(window) = &mut self.window else { return };
        let mut is_solved = window.optimise(&self.motions);
        if is_solved && window.judge_places() {
            is_solved = window.optimise(&self.motions);
        }
        if !is_solved {
            self.failures += 1;
            self.set_pose_unknown();
            return;
        }
        let newest = window.newest().stamp;
        let is_old = |window: &Window| {
            window.keyframes.len() > self.config.window.max_keyframes
                || window.keyframes.len() > 2
                    && newest - window.keyframes[1].stamp > self.config.window.length
        };
        while is_old(window) && window.remove_oldest(self.motions.config()) {}
        let oldest = window.keyframes[0].stamp;
        self.motions.forget_before(oldest);
        self.refresh();
    }

    /// Integrates the head again from the newest keyframe.
    fn refresh(&mut self) {
        let Some(window) = &self.window else { return };
        let keyframe = window.newest();
        let at = parameters(keyframe.state.bias, &window.border);
        let now = self.motions.newest().map_or(keyframe.stamp, |motion| motion.stamp);
        self.head = self.motions.between(keyframe.stamp, now, at);
        self.newest = Some(window.estimated_newest());
    }
}

/// Whether the newest keyframe has only an image near that of the previous keyframe.
fn is_provisional(config: &WindowConfig, keyframes: &[Keyframe]) -> bool {
    let [.., before, newest] = keyframes else { return false };
    let has_only_image = newest.visual.is_some() && newest.scan.is_none() && newest.error.start.is_none();
    let motion = &newest.motion;
    let is_near = motion.distance < config.keyframe_distance
        && motion.turned < config.keyframe_turn_deg.to_radians()
        && motion.duration < longest_time(config, motion);
    before.visual.is_some() && has_only_image && (is_near || motion.duration < config.keyframe_min_time)
}

/// Largest time between two keyframes with this motion, s.
fn longest_time(config: &WindowConfig, motion: &Preintegrated) -> f64 {
    let rests = motion.distance < REST_DISTANCE_M && motion.turned < REST_TURN_RAD;
    config.keyframe_max_time * if rests { REST_TIME_FACTOR } else { 1.0 }
}

fn is_usable(increment: &MotionIncrement) -> bool {
    let numbers = [increment.dt, increment.left, increment.right, increment.slip];
    increment.dt > 0.0
        && numbers.iter().all(|number| number.is_finite())
        && increment.turn_by_gyro.is_none_or(f64::is_finite)
        && increment.unobserved.iter().all(|number| number.is_finite())
}
