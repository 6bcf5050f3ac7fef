//! State of tracking between two frames.

use crate::frame::rgbd_frame::Frame;
use crate::motion::pose_belief::PoseBelief;
use crate::place_recognition::pending_relocalisations::PendingRelocalisations;
use crate::tracking::last_frame::LastFrame;
use crate::tracking::odometry_conflict::OdometryConflict;
use crate::tracking::pose_gate::PoseGate;
use trundle_core::{Pose3, Stamp};

/// Standard deviation of a dead-reckoned position above which a new map begins: 0.2 m. Continuing the map would give all later poses the
/// same error. Source: ours.
const MAX_CONTINUATION_SIGMA_M: f64 = 0.2;
/// Standard deviation of a dead-reckoned rotation above which a new map begins: 0.2 rad. Source: as [`MAX_CONTINUATION_SIGMA_M`].
const MAX_CONTINUATION_SIGMA_RAD: f64 = 0.2;

/// Predicted pose of the camera in the active map, and results of the last frames.
#[derive(Debug)]
pub(crate) struct TrackingState {
    pub belief: PoseBelief,
    /// Whether the camera's pose in the active map is known.
    pub pose_known: bool,
    /// Whether part of the motion since the last located frame was not measured.
    pub motion_unknown: bool,
    /// Whether the view changed abruptly: the camera was carried, or the lens is covered.
    pub view_discontinuity: bool,
    /// The last frame that was located.
    pub last: Option<LastFrame>,
    /// Number of frames since the last located one.
    pub lost_frames: usize,
    /// The last frame, if it was not located.
    pub lost_frame: Option<Frame>,
    pub pending_relocalisations: PendingRelocalisations,
    pub odometry_conflict: OdometryConflict,
}

impl TrackingState {
    /// A camera at a known pose.
    pub fn at(visual_from_camera: Pose3) -> Self {
        Self {
            belief: PoseBelief::at(visual_from_camera),
            pose_known: true,
            motion_unknown: false,
            view_discontinuity: false,
            last: None,
            lost_frames: 0,
            lost_frame: None,
            pending_relocalisations: PendingRelocalisations::default(),
            odometry_conflict: OdometryConflict::default(),
        }
    }

    /// Sets the camera's pose before the first frame.
    pub fn start_at(&mut self, visual_from_camera: Pose3) {
        self.belief = PoseBelief::at(visual_from_camera);
        self.pose_known = true;
    }

    /// Sets the camera's pose in the active map at the time of the last frame.
    pub fn restart_at(&mut self, visual_from_camera: Pose3) {
        self.belief = PoseBelief { stamp: self.belief.stamp, ..PoseBelief::at(visual_from_camera) };
        (self.pose_known, self.last) = (true, None);
    }

    /// Declares the camera's pose unknown.
    pub fn forget_pose(&mut self) {
        self.belief = PoseBelief { stamp: self.belief.stamp, ..PoseBelief::anywhere() };
        (self.pose_known, self.last, self.lost_frames) = (false, None, 0);
        self.pending_relocalisations = PendingRelocalisations::default();
    }

    /// Whether odometry cannot give the camera's pose in the active map.
    pub fn is_lost(&self) -> bool {
        self.motion_unknown || !self.pose_known || self.view_discontinuity
    }

    /// Whether dead reckoning is too uncertain to continue the map.
    pub fn is_too_uncertain(&self) -> bool {
        let sigma = |i: usize| self.belief.covariance[(i, i)].sqrt();
        (0..3).any(|i| sigma(i) > MAX_CONTINUATION_SIGMA_M)
            || (3..6).any(|i| sigma(i) > MAX_CONTINUATION_SIGMA_RAD)
    }

    /// The gate of poses at `now`, with or without a motion prior of the last step.
    pub fn gate(&self, now: Stamp, has_prior: bool) -> PoseGate {
        let is_first = self.belief.stamp.is_none();
        let elapsed = self.last.as_ref().map_or(f64::INFINITY, |last| (now - last.anchored.stamp).max(0.0));
        match has_prior {
            _ if !self.pose_known => PoseGate::Open,
            false if is_first => PoseGate::Covariance,
            true if !self.motion_unknown => PoseGate::Covariance,
            _ => PoseGate::Elapsed(elapsed),
        }
    }

    /// Ends a run of frames that were not located. Pending relocalisations stay: a weak frame may be tracked at a wrong place.
    pub fn end_lost_run(&mut self) {
        (self.lost_frames, self.lost_frame) = (0, None);
        (self.motion_unknown, self.view_discontinuity) = (false, false);
    }
}
