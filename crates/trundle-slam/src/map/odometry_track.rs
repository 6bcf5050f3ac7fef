//! The odometry since the newest keyframe, and the axis of the floor that it shows.

use crate::ids::KeyframeId;
use crate::map::landmark_map::LandmarkMap;
use crate::map::odometry_factor::OdometryFactor;
use crate::motion::floor_axis::FloorAxis;
use crate::motion::motion_model::MotionModelConfig;
use trundle_core::CameraMotion;

/// Odometry that is summed up between keyframes.
#[derive(Debug, Default)]
pub(crate) struct OdometryTrack {
    /// The motion since the newest keyframe, while all of it was measured.
    pub since_keyframe: Option<OdometryFactor>,
    /// Whether the newest frame contradicts that motion: a keyframe does not take it over.
    is_doubted: bool,
    /// Number of frames since the newest keyframe that contradict it.
    contradictions: usize,
    floor: FloorAxis,
}

/// Number of frames since a keyframe that may contradict the odometry. With more the odometry is wrong: a thing that moves before the
/// camera contradicts it in single frames, wheels that are stuck in one after the other. Source: ours.
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

    /// The odometry is not of the camera's motion since the newest keyframe any more.
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

    /// The factor for a new keyframe, if the keyframe before is still in the map.
    pub fn factor_in(&self, map: &LandmarkMap) -> Option<OdometryFactor> {
        self.since_keyframe.filter(|factor| !self.is_doubted && map.live_keyframe(factor.from).is_some())
    }

    /// Brings the map's axis of the floor up to date.
    pub fn update_floor(&self, map: &mut LandmarkMap) {
        map.floor = self.floor.axis_after(map.floor);
    }

    /// Restarts at a keyframe.
    pub fn start_at(&mut self, keyframe: KeyframeId) {
        self.since_keyframe = Some(OdometryFactor::at(keyframe));
        self.contradictions = 0;
    }
}
