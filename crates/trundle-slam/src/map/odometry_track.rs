//! The odometry since the newest keyframe, and the axis of the floor that it shows.

use crate::ids::KeyframeId;
use crate::map::landmark_map::LandmarkMap;
use crate::map::odometry_factor::OdometryFactor;
use crate::motion::floor_axis::FloorAxis;
use crate::motion::motion_model::MotionModelConfig;
use trundle_core::CameraMotion;

/// Odometry accumulated between keyframes.
#[derive(Debug, Default)]
pub(crate) struct OdometryTrack {
    /// The motion since the newest keyframe; `None` if part of it was not measured.
    pub since_keyframe: Option<OdometryFactor>,
    /// Whether the newest frame contradicts that motion. A keyframe then gets no odometry factor.
    is_doubted: bool,
    /// Number of contradicting frames since the newest keyframe.
    contradictions: usize,
    floor: FloorAxis,
}

/// Largest number of frames since a keyframe that contradict a usable odometry: 2. With more the odometry is wrong. A moving object
/// contradicts it in single frames, stuck wheels in every frame. Source: ours.
const MAX_CONTRADICTIONS: usize = 2;

impl OdometryTrack {
    /// Takes the motion prior of a frame and its duration, s.
    pub fn extend(&mut self, prior: Option<CameraMotion>, seconds: f64, config: &MotionModelConfig) {
        let extended =
            |(factor, step): (OdometryFactor, CameraMotion)| factor.extended_by(step, seconds, config);
        self.since_keyframe = self.since_keyframe.zip(prior).and_then(extended);
        if let Some(step) = prior {
            self.floor.record(step.motion);
        }
    }

    /// Marks the odometry since the newest keyframe as unusable.
    pub fn interrupt(&mut self) {
        self.since_keyframe = None;
    }

    /// Notes whether the newest frame contradicts the odometry.
    pub fn set_doubted(&mut self, is_doubted: bool) {
        self.is_doubted = is_doubted;
        self.contradictions += usize::from(is_doubted);
        if self.contradictions > MAX_CONTRADICTIONS {
            self.interrupt();
        }
    }

    /// The factor for a new keyframe, if the previous keyframe is still in the map.
    pub fn factor_in(&self, map: &LandmarkMap) -> Option<OdometryFactor> {
        self.since_keyframe.filter(|factor| !self.is_doubted && map.live_keyframe(factor.from).is_some())
    }

    /// Updates the map's axis of the floor.
    pub fn update_floor(&self, map: &mut LandmarkMap) {
        map.floor = self.floor.axis_after(map.floor);
    }

    /// Restarts at a keyframe.
    pub fn start_at(&mut self, keyframe: KeyframeId) {
        self.since_keyframe = Some(OdometryFactor::at(keyframe));
        self.contradictions = 0;
    }
}
