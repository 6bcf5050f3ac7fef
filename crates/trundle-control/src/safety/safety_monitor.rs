//! The safety monitor: evaluates one command.

use super::free_motion::FreeMotion;
use super::safety_action::{SafetyAction, SafetyReport, SlowReason, StopReason};
use super::safety_config::SafetyConfig;
use super::safety_input::{MotionSense, SafetyInput};
use trundle_core::{Footprint, Invalid, Twist2};

/// Age of an image that was just taken, s. Source: ours.
const FRESH_IMAGE_AGE_S: f64 = 0.0;

/// Passes only twists from which the robot can still stop.
#[derive(Debug, Clone, PartialEq)]
pub struct SafetyMonitor {
    config: SafetyConfig,
    motion: FreeMotion,
}

impl SafetyMonitor {
    /// A monitor for a robot of this footprint.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: SafetyConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        Ok(Self { config: config.validated()?, motion: FreeMotion::new(footprint) })
    }

    /// Checks a command.
    pub fn check(&mut self, input: &SafetyInput<'_>) -> SafetyReport {
        if let Some(reason) = input.missing(&self.config) {
            return SafetyReport::stop(reason);
        }
        // The camera does not cover the area behind, so an old image does not forbid to back out of a contact.
        if self.must_back_out(input) && (input.image.is_some() || input.station_motion().is_some()) {
            return self.back_out(input);
        }
        if let Some(reason) = input.lost_perception(&self.config) {
            return self.turn_without_view(input, reason);
        }
        self.motion.observe(input, input.image_age(), &self.config);
        if input.twist.v == 0.0 {
            return self.motion.limited_turn(input.twist, &self.config);
        }
        self.limited_drive(input)
    }

    /// A commanded turn on the spot, which may restore the view. Obstacles that are known count; the age of the image does not.
    fn turn_without_view(&mut self, input: &SafetyInput<'_>, reason: StopReason) -> SafetyReport {
        if input.twist.v != 0.0 || reason == StopReason::NoImage {
            return SafetyReport::stop(reason);
        }
        self.motion.observe(input, FRESH_IMAGE_AGE_S, &self.config);
        let twist = self.motion.limited_turn(input.twist, &self.config).twist;
        SafetyReport { twist, action: SafetyAction::Stop(reason) }
    }

    /// The slowest of the limits of a drive. Of equal ones the first is reported.
    fn limited_drive(&self, input: &SafetyInput<'_>) -> SafetyReport {
        let (config, twist, age) = (&self.config, input.twist, input.image_age());
        let reverse = if twist.v < 0.0 { config.reverse_speed } else { f64::INFINITY };
        let uncounted =
            if input.motion == MotionSense::Wheels { f64::INFINITY } else { config.uncounted_speed };
        let path = self.motion.limited_path(twist, config.stop_margin, config);
        if matches!(path.action, SafetyAction::Stop(_)) {
            return path;
        }
        [
            SafetyReport::slowed(twist, reverse, SlowReason::Reversing),
            self.motion.limited_by_gap(twist, config),
            path,
            SafetyReport::slowed(twist, config.speed_at_age(age), SlowReason::OldImage { age }),
            SafetyReport::slowed(twist, uncounted, SlowReason::WheelsCountNothing),
        ]
        .into_iter()
        .reduce(SafetyReport::slower)
        .unwrap_or(path)
    }

    /// Whether only backing out is allowed; a disc may still turn on the spot in contact.
    fn must_back_out(&self, input: &SafetyInput<'_>) -> bool {
        let turns = input.twist.v == 0.0 && input.twist.omega != 0.0 && self.motion.is_disc();
        input.over_edge || input.touched && !turns
    }

    /// Slowly backward, up to an obstacle behind. No stop margin is kept there: the robot needs room more than distance.
    fn back_out(&mut self, input: &SafetyInput<'_>) -> SafetyReport {
        if input.twist.v >= 0.0 {
            return SafetyReport::stop(if input.touched { StopReason::Touched } else { StopReason::Cliff });
        }
        self.motion.observe(input, FRESH_IMAGE_AGE_S, &self.config);
        let slowed = SafetyReport::slowed(input.twist, self.config.back_out_speed, SlowReason::BackingOut);
        let free = self.motion.limited_path(slowed.twist, 0.0, &self.config);
        // Before an obstacle behind, the turn of the command is no way out: over an edge a wheel may lose the floor.
        if matches!(free.action, SafetyAction::Stop(_)) {
            return SafetyReport { twist: Twist2::ZERO, ..free };
        }
        slowed.slower(free)
    }
}
