//! The free part of a motion: the first contact of the swept footprint, and the speed from which the robot stops before it.

use super::obstacles::{Obstacle, collect_memory, collect_scan};
use super::safety_action::{SafetyAction, SafetyReport, SlowReason, StopReason};
use super::safety_config::SafetyConfig;
use super::safety_input::SafetyInput;
use trundle_collision::{RoundedHull, arc_contact};
use trundle_core::{Footprint, Twist2, Vector2};

/// Largest difference of two equal distances to a wall, m. Larger: the robot may drift towards a wall. Source: a row of round cells varies
/// by 1.5 mm; ours.
const SAME_DISTANCE_M: f64 = 3e-3;

/// Slack of a turn on the spot, m: the nearest obstacle lies outside the margin, so that its contact with another part of the outline is
/// found. Larger: the robot may turn towards an obstacle. Source: ten times the tolerance of a contact.
const ROUNDING_M: f64 = 1e-8;

/// Slowest turn on the spot, rad/s: a slower one is a stop. Source: ours.
const MIN_TURN_RATE_RAD_PER_S: f64 = 0.02;

/// The footprint among the obstacles near the robot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FreeMotion {
    footprint: RoundedHull,
    /// Obstacles near by, reused from step to step.
    obstacles: Vec<Obstacle>,
    /// Time from the newest image to the response of the wheels, s.
    latency: f64,
}

impl FreeMotion {
    pub(super) fn new(footprint: &Footprint) -> Self {
        Self { footprint: RoundedHull::exact(footprint), obstacles: Vec::new(), latency: 0.0 }
    }

    pub(super) fn is_disc(&self) -> bool {
        self.footprint.is_disc()
    }

    /// Collects the obstacles that count for the command, with an image of `image_age` s. At a station, those of the station do not.
    pub(super) fn observe(&mut self, input: &SafetyInput<'_>, image_age: f64, config: &SafetyConfig) {
        self.latency = config.latency_for(image_age);
        self.obstacles.clear();
        let path = config.braking_distance(input.twist, self.latency) + config.stop_margin;
        let body = self.footprint.outer_radius() + config.slow_margin.max(config.stop_margin);
        if let Some(scan) = &input.scan {
            collect_scan(scan, path + body, &mut self.obstacles);
        }
        if let Some(memory) = &input.memory {
            collect_memory(memory, path.min(config.memory_reach) + body, &mut self.obstacles);
        }
        if let Some(station) = input.station_motion() {
            self.obstacles.retain(|obstacle| !station.is_station(obstacle.at));
        }
    }

    /// The turn on the spot at a rate from which it ends before the first contact.
    pub(super) fn limited_turn(&self, turn: Twist2, config: &SafetyConfig) -> SafetyReport {
        // A turn has no stop margin: every step would use a larger slack again.
        let Some((angle, at)) = self.first_contact(turn, self.contact_margin(ROUNDING_M, config)) else {
            return SafetyReport::pass(turn);
        };
        let rate = config.turn_rate_for(angle, self.latency);
        if rate >= turn.omega.abs() {
            SafetyReport::pass(turn)
        } else if rate < MIN_TURN_RATE_RAD_PER_S {
            SafetyReport::stop(StopReason::ObstacleBeside { angle, at })
        } else {
            let twist = Twist2::new(0.0, rate.copysign(turn.omega));
            SafetyReport { twist, action: SafetyAction::Slow(SlowReason::ObstacleBeside { angle, at }) }
        }
    }

    /// The twist at a speed from which the robot stops `stop_margin` m before the first contact.
    pub(super) fn limited_path(
        &self,
        twist: Twist2,
        stop_margin: f64,
        config: &SafetyConfig,
    ) -> SafetyReport {
        let contact = self.first_contact(twist, self.contact_margin(SAME_DISTANCE_M, config));
        let Some((distance, at)) = contact else { return SafetyReport::pass(twist) };
        let speed = config.speed_for(twist, distance - stop_margin, self.latency);
        if speed < config.min_speed.min(twist.v.abs()) {
            let turn = self.limited_turn(Twist2::new(0.0, twist.omega), config).twist;
            let action = SafetyAction::Stop(StopReason::ObstacleAhead { distance, at });
            return SafetyReport { twist: turn, action };
        }
        SafetyReport::slowed(twist, speed, SlowReason::ObstacleAhead { distance, at })
    }

    /// The twist slowed before an obstacle close to the side of its path.
    pub(super) fn limited_by_gap(&self, twist: Twist2, config: &SafetyConfig) -> SafetyReport {
        let Some((distance, at)) = self.first_contact(twist, config.slow_margin) else {
            return SafetyReport::pass(twist);
        };
        let speed = config.speed_for(twist, distance, self.latency).max(config.creep_speed);
        SafetyReport::slowed(twist, speed, SlowReason::NarrowGap { at })
    }

    /// First obstacle that comes within `margin` m of the footprint: distance (for a turn on the spot, angle) and position.
    fn first_contact(&self, twist: Twist2, margin: f64) -> Option<(f64, Vector2)> {
        let contact =
            |o: &Obstacle| Some((arc_contact(&self.footprint, twist, o.at, margin + o.extent)?, o.at));
        self.obstacles.iter().filter_map(contact).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Margin around the footprint that must be free, m. A robot within the configured margin may move if it comes no nearer than `slack`:
    /// otherwise it could never leave a wall.
    fn contact_margin(&self, slack: f64, config: &SafetyConfig) -> f64 {
        let gaps = self.obstacles.iter().map(|o| self.footprint.signed_distance(o.at) - o.extent);
        (gaps.fold(f64::INFINITY, f64::min) - slack).clamp(0.0, config.side_margin)
    }
}
