//! Whether the robot has a usable view, and how it regains one.

use super::sight_recovery::SightRecovery;
use crate::world_state::WorldState;
use trundle_control::{MotionSense, is_stale};
use trundle_core::{Stamp, Twist2};

/// The robot's view, and the turns that restore it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ViewMonitor {
    recovery: SightRecovery,
    /// The safety monitor's timeout of images, s.
    image_timeout: f64,
}

/// Time without a usable scan \[s\] after which the robot turns to regain one. Source: ours.
const BLIND_PAUSE_S: f64 = 3.0;

impl ViewMonitor {
    /// A view that counts as lost `image_timeout` s after the last image with content.
    pub(crate) fn new(image_timeout: f64) -> Self {
        Self { recovery: SightRecovery::default(), image_timeout }
    }

    /// Resets the count for the next goal.
    pub(crate) fn restart(&mut self) {
        self.recovery = SightRecovery::default();
    }

    /// Whether no image has had content within the safety monitor's timeout, or neither wheels nor images measure the motion.
    pub(crate) fn is_blind(&self, s: &WorldState<'_>) -> bool {
        s.motion == MotionSense::Nothing
            || s.seen.is_none_or(|seen| is_stale(s.now - seen, self.image_timeout))
    }

    /// Records the twist that the robot would make, before the view may be lost.
    pub(crate) fn held(&mut self, wanted: Twist2) {
        self.recovery.held(wanted);
    }

    /// A camera too near to a wall gives no depth. After a pause, one turn on the spot separates this from a broken camera. `held_since`
    /// is the stamp of the stop.
    pub(crate) fn recover(&mut self, held_since: Option<Stamp>, s: &WorldState<'_>) -> Twist2 {
        // Images with content that do not measure the motion do not count.
        let seen = s.seen.filter(|_| s.motion != MotionSense::Nothing);
        let since = held_since.max(seen);
        let is_long = since.is_some_and(|since| s.now - since >= BLIND_PAUSE_S);
        if is_long { self.recovery.turn(s.estimate.pose) } else { Twist2::ZERO }
    }

    /// Checks whether a usable scan came back after a time without one. Returns whether a turn restored the view for the second time at
    /// this place: the path leads into the camera's blind range.
    pub(crate) fn is_restored_in_vain(&mut self, s: &WorldState<'_>) -> bool {
        !self.is_blind(s) && self.recovery.sees(s.estimate.pose.position())
    }
}
