//! Input of the safety monitor, and the conditions under which no motion may pass.

use super::hold::MotionHold;
use super::obstacles::{SafetyMemory, SafetyScan};
use super::safety_action::StopReason;
use super::safety_config::SafetyConfig;
use super::station_motion::StationMotion;
use trundle_core::{Stamp, Twist2};

/// Input of the monitor's decision.
#[derive(Debug, Clone, Copy)]
pub struct SafetyInput<'a> {
    /// The moment of the command.
    pub now: Stamp,
    /// The command.
    pub twist: Twist2,
    /// The newest scan.
    pub scan: Option<SafetyScan<'a>>,
    /// The map near by: obstacles too near for the camera, or out of its view.
    pub memory: Option<SafetyMemory<'a>>,
    /// Whether the bumper is pressed.
    pub touched: bool,
    /// Whether a cliff sensor detects no floor.
    pub over_edge: bool,
    /// A condition of the body under which no wheel may turn.
    pub hold: Option<MotionHold>,
    /// Stamp of the newest image with content.
    pub image: Option<Stamp>,
    /// Stamp of the newest wheel reading.
    pub wheels: Option<Stamp>,
    /// The source that measures the robot's motion.
    pub motion: MotionSense,
    /// The intended motion at a charging station. `None` elsewhere.
    pub station: Option<StationMotion>,
}

/// Sensor of the motion since the scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MotionSense {
    /// The wheel encoders measure the motion.
    #[default]
    Wheels,
    /// The wheels are commanded while the encoders count nothing; images or scans measure the motion, with a delay.
    Sight,
    /// No sensor measures the motion.
    Nothing,
}

impl SafetyInput<'_> {
    /// The motion at a charging station, if the command is one.
    pub(super) fn station_motion(&self) -> Option<StationMotion> {
        self.station.filter(|motion| motion.permits(self.twist))
    }

    /// Age of the newest image, s. It counts as 0 near a station, where the camera may be blind: the bumper and the map replace it there.
    pub(super) fn image_age(&self) -> f64 {
        self.image.filter(|_| self.station_motion().is_none()).map_or(0.0, |image| self.now - image)
    }

    /// Reason why no command may pass: a number is not finite, the body holds the robot, or wheel readings are missing.
    pub(super) fn missing(&self, config: &SafetyConfig) -> Option<StopReason> {
        let scan_poses = self.scan.iter().flat_map(|scan| [scan.odom_at_scan, scan.odom_now]);
        let mut poses = scan_poses.chain(self.memory.iter().map(|memory| memory.map_from_base));
        if !self.twist.is_finite() || !poses.all(|pose| pose.is_finite()) {
            return Some(StopReason::NotFinite);
        }
        if let Some(hold) = self.hold {
            return Some(StopReason::Held(hold));
        }
        let Some(wheels) = self.wheels else { return Some(StopReason::NoWheels) };
        let age = self.now - wheels;
        is_stale(age, config.wheels_timeout).then_some(StopReason::StaleWheels { age })
    }

    /// Reason for the loss of perception, if images are missing or no sensor measures the motion.
    pub(super) fn lost_perception(&self, config: &SafetyConfig) -> Option<StopReason> {
        let nothing = (self.motion == MotionSense::Nothing).then_some(StopReason::NothingTellsMotion);
        if self.station_motion().is_some() {
            return nothing;
        }
        let Some(image) = self.image else {
            return Some(if self.scan.is_some() { StopReason::NothingSeen } else { StopReason::NoImage });
        };
        let age = self.now - image;
        if is_stale(age, config.image_timeout) { Some(StopReason::StaleImage { age }) } else { nothing }
    }
}

/// Largest time of a stamp ahead of the clock \[s\]: beyond it two clocks differ, and the reading would become old too late. Source: ours,
/// the default time-out of the wheels.
const MAX_CLOCK_AHEAD_S: f64 = 0.2;

/// Whether a reading of `age` s is useless: older than `timeout` s, or stamped more than 0.2 s ahead of the clock.
#[must_use]
pub fn is_stale(age: f64, timeout: f64) -> bool {
    age > timeout || age < -MAX_CLOCK_AHEAD_S
}
