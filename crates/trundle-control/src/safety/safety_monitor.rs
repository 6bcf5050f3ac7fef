//! The safety monitor: evaluates one command.

use crate::safety::hold::MotionHold;
use crate::safety::obstacles::{Obstacle, SafetyMemory, SafetyScan, collect_memory, collect_scan};
use crate::safety::safety_action::{SafetyAction, SlowReason, StopReason};
use crate::safety::safety_config::SafetyConfig;
use crate::safety::station_motion::StationMotion;
use trundle_collision::{RoundedHull, arc_contact};
use trundle_core::{Footprint, Invalid, Stamp, Twist2, Vector2};

/// Passes only twists from which the robot can still stop.
#[derive(Debug, Clone, PartialEq)]
pub struct SafetyMonitor {
    config: SafetyConfig,
    footprint: RoundedHull,
    /// Time from the newest image to the response of the wheels, s.
    latency: f64,
    /// Obstacles near by, reused from call to call.
    obstacles: Vec<Obstacle>,
}

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

impl SafetyInput<'_> {
    /// The motion at a charging station, if the command is one.
    fn station_motion(&self) -> Option<StationMotion> {
        self.station.filter(|motion| motion.permits(self.twist))
    }
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

/// Decision of the monitor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafetyReport {
    /// The twist to send: always safe, always finite.
    pub twist: Twist2,
    /// The change of the command, and its reason.
    pub action: SafetyAction,
}

/// Largest difference of two equal distances to a wall, m. Larger: the robot may drift towards a wall. Source: a row of round cells varies
/// by 1.5 mm; ours.
const SAME_DISTANCE_M: f64 = 3e-3;

/// Slowest turn on the spot, rad/s: a slower one is a stop. Source: ours.
const MIN_TURN_RATE_RAD_PER_S: f64 = 0.02;

/// Free path along the arc.
struct FreePath {
    /// Distance to contact, m, and the obstacle.
    contact: Option<(f64, Vector2)>,
    /// The first obstacle close to the side of the arc: distance until abreast, m, and position.
    beside: Option<(f64, Vector2)>,
}

impl SafetyMonitor {
    /// A monitor for a robot of this footprint.
    ///
    /// # Errors
    /// When a number of the configuration is outside its range.
    pub fn new(config: SafetyConfig, footprint: &Footprint) -> Result<Self, Invalid> {
        let (config, footprint) = (config.validated()?, RoundedHull::exact(footprint));
        Ok(Self { latency: config.latency, config, footprint, obstacles: Vec::new() })
    }

    /// Checks a command.
    pub fn check(&mut self, input: &SafetyInput<'_>) -> SafetyReport {
        if let Some(reason) = self.missing_input(input) {
            return stop(reason);
        }
        // The camera does not cover the area behind, so an old image does not forbid to back out of a contact.
        let station = input.station_motion();
        if self.must_back_out(input) && (input.image.is_some() || station.is_some()) {
            return self.back_out(input);
        }
        if let Some(reason) = self.lost_perception(input) {
            // A disc may always turn on the spot if that was commanded: a turn may restore the view.
            let turns = input.twist.v == 0.0 && reason != StopReason::NoImage;
            let omega = if turns { input.twist.omega } else { 0.0 };
            return SafetyReport { twist: Twist2::new(0.0, omega), action: SafetyAction::Stop(reason) };
        }
        if input.twist.v == 0.0 && self.needs_no_turn_check(input.twist) {
            return SafetyReport { twist: input.twist, action: SafetyAction::Pass };
        }
        // Near a station the camera may be blind; the bumper and the map replace the camera there.
        let age = input.image.filter(|_| station.is_none()).map_or(0.0, |image| input.now - image);
        self.latency = self.config.latency_for(age);
        self.collect_obstacles(input);
        if let Some(station) = station {
            self.obstacles.retain(|obstacle| !station.is_station(obstacle.at));
        }
        if input.twist.v == 0.0 {
            return self.limited_by_free_turn(input.twist);
        }
        let slowed = slowed_to(input.twist, self.config.speed_at_age(age), SlowReason::OldImage { age });
        slower_of(
            self.limited_by_free_path(input.twist),
            slower_of(slowed, self.limited_by_uncounted_wheels(input)),
        )
    }

    /// Reason why no command may pass: a number is not finite, the body holds the robot, or wheel readings are missing.
    fn missing_input(&self, input: &SafetyInput<'_>) -> Option<StopReason> {
        let poses = input.scan.iter().flat_map(|s| [s.odom_at_scan, s.odom_now]);
        let mut poses = poses.chain(input.memory.iter().map(|m| m.map_from_base));
        if !input.twist.is_finite() || !poses.all(|pose| pose.is_finite()) {
            return Some(StopReason::NotFinite);
        }
        if let Some(hold) = input.hold {
            return Some(StopReason::Held(hold));
        }
        let Some(wheels) = input.wheels else { return Some(StopReason::NoWheels) };
        let age = input.now - wheels;
        (age > self.config.wheels_timeout).then_some(StopReason::StaleWheels { age })
    }

    /// Reason for the loss of perception, if images are missing or no sensor measures the motion.
    fn lost_perception(&self, input: &SafetyInput<'_>) -> Option<StopReason> {
        let nothing = (input.motion == MotionSense::Nothing).then_some(StopReason::NothingTellsMotion);
        if input.station_motion().is_some() {
            return nothing;
        }
        let Some(image) = input.image else {
            return Some(if input.scan.is_some() { StopReason::NothingSeen } else { StopReason::NoImage });
        };
        let age = input.now - image;
        if age > self.config.image_timeout {
            return Some(StopReason::StaleImage { age });
        }
        nothing
    }

    /// Limits the speed of a robot whose wheel encoders count nothing.
    fn limited_by_uncounted_wheels(&self, input: &SafetyInput<'_>) -> SafetyReport {
        let speed =
            if input.motion == MotionSense::Wheels { f64::INFINITY } else { self.config.uncounted_speed };
        slowed_to(input.twist, speed, SlowReason::WheelsCountNothing)
    }

    /// Whether only backing out is allowed; a disc may still turn on the spot in contact.
    fn must_back_out(&self, input: &SafetyInput<'_>) -> bool {
        let turns = input.twist.v == 0.0 && input.twist.omega != 0.0 && self.footprint.is_disc();
        input.over_edge || input.touched && !turns
    }

    fn back_out(&self, input: &SafetyInput<'_>) -> SafetyReport {
        if input.twist.v < 0.0 {
            slowed_to(input.twist, self.config.back_out_speed, SlowReason::BackingOut)
        } else {
            stop(if input.touched { StopReason::Touched } else { StopReason::Cliff })
        }
    }

    fn collect_obstacles(&mut self, input: &SafetyInput<'_>) {
        self.obstacles.clear();
        let v = input.twist.v.abs();
        let braking = v * self.latency + v * v / (2.0 * self.config.deceleration);
        let body = self.footprint.outer_radius() + self.config.slow_margin.max(self.config.stop_margin);
        if let Some(scan) = &input.scan {
            collect_scan(scan, braking + self.config.stop_margin + body, &mut self.obstacles);
        }
        if let Some(memory) = &input.memory {
            let reach = (braking + self.config.stop_margin).min(self.config.memory_reach) + body;
            collect_memory(memory, reach, &mut self.obstacles);
        }
    }

    fn free_path(&self, twist: Twist2) -> FreePath {
        FreePath {
            contact: self.first_contact(twist, self.contact_margin(SAME_DISTANCE_M)),
            beside: self.first_contact(twist, self.config.slow_margin),
        }
    }

    /// First obstacle that comes within `margin` m of the footprint: distance (for a turn on the spot, angle) and position.
    fn first_contact(&self, twist: Twist2, margin: f64) -> Option<(f64, Vector2)> {
        let contact =
            |o: &Obstacle| Some((arc_contact(&self.footprint, twist, o.at, margin + o.extent)?, o.at));
        self.obstacles.iter().filter_map(contact).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Margin around the footprint that must be free, m. A robot within the configured margin may move if it comes no nearer than `slack`:
    /// otherwise it could never leave a wall.
    fn contact_margin(&self, slack: f64) -> f64 {
        let gaps = self.obstacles.iter().map(|o| self.footprint.signed_distance(o.at) - o.extent);
        (gaps.fold(f64::INFINITY, f64::min) - slack).clamp(0.0, self.config.side_margin)
    }

    /// Whether a turn on the spot needs no check.
    fn needs_no_turn_check(&self, turn: Twist2) -> bool {
        turn.omega == 0.0 || self.footprint.is_disc()
    }

    fn limited_by_free_turn(&self, turn: Twist2) -> SafetyReport {
        // No slack: a turn has no stop margin, so every step would use the slack again.
        let contact = if self.needs_no_turn_check(turn) {
            None
        } else {
            self.first_contact(turn, self.contact_margin(0.0))
        };
        let Some((angle, at)) = contact else {
            return SafetyReport { twist: turn, action: SafetyAction::Pass };
        };
        let rate = self.config.turn_rate_for(angle, self.latency);
        if rate >= turn.omega.abs() {
            SafetyReport { twist: turn, action: SafetyAction::Pass }
        } else if rate < MIN_TURN_RATE_RAD_PER_S {
            stop(StopReason::ObstacleBeside { angle, at })
        } else {
            let twist = Twist2::new(0.0, rate.copysign(turn.omega));
            SafetyReport { twist, action: SafetyAction::Slow(SlowReason::ObstacleBeside { angle, at }) }
        }
    }

    fn limited_by_free_path(&self, twist: Twist2) -> SafetyReport {
        let free = self.free_path(twist);
        let mut report = SafetyReport { twist, action: SafetyAction::Pass };
        if twist.v < 0.0 {
            report = slowed_to(twist, self.config.reverse_speed, SlowReason::Reversing);
        }
        if let Some((distance, at)) = free.beside {
            let speed = self.config.speed_for(distance, self.latency).max(self.config.creep_speed);
            report = slower_of(report, slowed_to(twist, speed, SlowReason::NarrowGap { at }));
        }
        if let Some((distance, at)) = free.contact {
            let speed = self.config.speed_for(distance - self.config.stop_margin, self.latency);
            if speed < self.config.min_speed.min(twist.v.abs()) {
                let turn = self.limited_by_free_turn(Twist2::new(0.0, twist.omega)).twist;
                let action = SafetyAction::Stop(StopReason::ObstacleAhead { distance, at });
                return SafetyReport { twist: turn, action };
            }
            report = slower_of(report, slowed_to(twist, speed, SlowReason::ObstacleAhead { distance, at }));
        }
        report
    }
}

fn stop(reason: StopReason) -> SafetyReport {
    SafetyReport { twist: Twist2::ZERO, action: SafetyAction::Stop(reason) }
}

/// The twist slowed to at most this speed, m/s, on its own curve.
fn slowed_to(twist: Twist2, speed: f64, reason: SlowReason) -> SafetyReport {
    let part = speed / twist.v.abs();
    if part >= 1.0 {
        return SafetyReport { twist, action: SafetyAction::Pass };
    }
    let twist = Twist2::new(twist.v * part, twist.omega * part);
    SafetyReport { twist, action: SafetyAction::Slow(reason) }
}

fn slower_of(a: SafetyReport, b: SafetyReport) -> SafetyReport {
    if b.twist.v.abs() < a.twist.v.abs() { b } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Beam, Pose2, Scan};

    fn monitor() -> SafetyMonitor {
        SafetyMonitor::new(SafetyConfig::default(), &Footprint::KOBUKI).unwrap()
    }

    fn fresh(twist: Twist2) -> SafetyInput<'static> {
        let now = Stamp::default();
        SafetyInput {
            now,
            twist,
            scan: None,
            memory: None,
            touched: false,
            over_edge: false,
            hold: None,
            image: Some(now),
            wheels: Some(now),
            motion: MotionSense::Wheels,
            station: None,
        }
    }

    fn scan(angle_min: f64, increment: f64, ranges: &[f64]) -> Scan {
        let beams = ranges.iter().map(|&range| Beam::Hit { range }).collect();
        Scan::new(Stamp::default(), Vector2::zeros(), angle_min, increment, beams).unwrap()
    }

    fn seen(scan: &Scan) -> Option<SafetyScan<'_>> {
        Some(SafetyScan { scan, odom_at_scan: Pose2::IDENTITY, odom_now: Pose2::IDENTITY })
    }

    #[test]
    fn without_images_or_wheels_it_stops_with_a_reason() {
        let twist = Twist2::new(0.3, 0.1);
        let now = Stamp::default().after(10.0);
        let reason = |input: SafetyInput<'_>| match monitor().check(&input) {
            SafetyReport { twist: Twist2::ZERO, action: SafetyAction::Stop(reason) } => reason,
            report => panic!("{report:?}"),
        };
        let input = SafetyInput { now, image: Some(now), wheels: Some(now), ..fresh(twist) };
        assert_eq!(monitor().check(&input).action, SafetyAction::Pass);
        assert_eq!(reason(SafetyInput { image: None, ..input }), StopReason::NoImage);
        assert_eq!(reason(SafetyInput { wheels: None, ..input }), StopReason::NoWheels);
        let old = Some(now.after(-1.0));
        assert_eq!(reason(SafetyInput { image: old, ..input }), StopReason::StaleImage { age: 1.0 });
        let turn = SafetyInput { image: old, twist: Twist2::new(0.0, 0.1), ..input };
        assert_eq!(monitor().check(&turn).twist, turn.twist, "a turn on the spot is not a risk");
        assert_eq!(reason(SafetyInput { wheels: old, ..input }), StopReason::StaleWheels { age: 1.0 });
        assert_eq!(reason(SafetyInput { twist: Twist2::new(f64::NAN, 0.0), ..input }), StopReason::NotFinite);
        assert_eq!(reason(SafetyInput { touched: true, ..input }), StopReason::Touched);
        assert_eq!(reason(SafetyInput { over_edge: true, ..input }), StopReason::Cliff);
        let hold = Some(MotionHold::WheelDrop);
        for twist in [twist, Twist2::new(-0.1, 0.0), Twist2::new(0.0, 0.5)] {
            let stop = reason(SafetyInput { hold, touched: true, twist, ..input });
            assert_eq!(stop, StopReason::Held(MotionHold::WheelDrop), "neither turns nor backing out pass");
        }
    }

    #[test]
    fn contact_with_a_station_is_permitted_and_with_anything_else_is_not() {
        let (creep, now) = (Twist2::new(0.05, 0.0), Stamp::default().after(10.0));
        let wall = |range: f64| scan(-0.2, 0.05, &[range; 9]);
        let base_from_station = Pose2::new(0.2, 0.0, std::f64::consts::PI);
        let docking = Some(StationMotion::Docking { base_from_station, distance_error: 0.0 });
        let near = wall(0.2);
        let input = SafetyInput { scan: seen(&near), now, wheels: Some(now), ..fresh(creep) };
        assert_eq!(monitor().check(&SafetyInput { image: Some(now), ..input }).twist.v, 0.0);
        let docked = SafetyInput { station: docking, ..input };
        assert_eq!(monitor().check(&docked).twist, creep, "the image is 10 s old, and the station is ahead");
        assert_eq!(monitor().check(&SafetyInput { image: None, ..docked }).twist, creep);
        // Another speed, another obstacle, a pressed bumper, a cliff: as anywhere else.
        let fast = SafetyInput { twist: Twist2::new(0.2, 0.0), ..docked };
        assert_eq!(monitor().check(&fast).twist.v, 0.0);
        let base_from_station = Pose2::new(0.5, 0.0, std::f64::consts::PI);
        let far = Some(StationMotion::Docking { base_from_station, distance_error: 0.0 });
        assert_eq!(
            monitor().check(&SafetyInput { station: far, ..input }).twist.v,
            0.0,
            "before the station"
        );
        for blocked in [SafetyInput { touched: true, ..docked }, SafetyInput { over_edge: true, ..docked }] {
            assert_eq!(monitor().check(&blocked).twist, Twist2::ZERO);
        }
        let nothing = SafetyInput { motion: MotionSense::Nothing, ..docked };
        assert_eq!(monitor().check(&nothing).twist, Twist2::ZERO);
    }

    #[test]
    fn a_robot_leaves_its_station_backward_though_its_camera_sees_nothing() {
        let back = SafetyInput {
            image: None,
            station: Some(StationMotion::Undocking),
            ..fresh(Twist2::new(-0.1, 0.0))
        };
        assert_eq!(monitor().check(&back).twist.v, -0.1);
        assert_eq!(monitor().check(&SafetyInput { touched: true, ..back }).twist.v, -0.05);
        assert_eq!(monitor().check(&SafetyInput { station: None, ..back }).twist, Twist2::ZERO);
        assert_eq!(
            monitor().check(&SafetyInput { twist: Twist2::new(0.1, 0.0), ..back }).twist,
            Twist2::ZERO
        );
    }

    #[test]
    fn whose_wheels_count_nothing_goes_slowly_and_says_so() {
        let twist = Twist2::new(0.5, 0.4);
        let report = monitor().check(&SafetyInput { motion: MotionSense::Sight, ..fresh(twist) });
        assert_eq!(report.action, SafetyAction::Slow(SlowReason::WheelsCountNothing));
        assert!(
            (report.twist.v - 0.15).abs() < 1e-12 && (report.twist.omega - 0.12).abs() < 1e-12,
            "{report:?}"
        );
        let creeping = SafetyInput { motion: MotionSense::Sight, ..fresh(Twist2::new(0.1, 0.4)) };
        assert_eq!(monitor().check(&creeping).action, SafetyAction::Pass);
        let nothing = SafetyInput { motion: MotionSense::Nothing, ..fresh(twist) };
        let stopped = SafetyAction::Stop(StopReason::NothingTellsMotion);
        assert_eq!(monitor().check(&nothing), SafetyReport { twist: Twist2::ZERO, action: stopped });
        let turn = SafetyInput { twist: Twist2::new(0.0, 0.4), ..nothing };
        assert_eq!(monitor().check(&turn).twist, turn.twist, "so it may come to see more");
    }

    #[test]
    fn from_a_touch_it_backs_out_slowly() {
        let report = monitor().check(&SafetyInput { touched: true, ..fresh(Twist2::new(-0.3, 0.3)) });
        assert_eq!(report.action, SafetyAction::Slow(SlowReason::BackingOut));
        assert!((report.twist.v + 0.05).abs() < 1e-12 && (report.twist.omega - 0.05).abs() < 1e-12);
    }

    #[test]
    fn lost_perception_it_leaves_what_it_touches_backward_and_turns_but_goes_no_further_on() {
        let now = Stamp::default().after(10.0);
        let old = SafetyInput { now, wheels: Some(now), touched: true, ..fresh(Twist2::new(-0.05, 0.0)) };
        assert_eq!(monitor().check(&old).twist, Twist2::new(-0.05, 0.0));
        let turn = Twist2::new(0.0, 0.5);
        assert_eq!(monitor().check(&SafetyInput { twist: turn, ..old }).twist, turn);
        assert_eq!(monitor().check(&SafetyInput { twist: turn, over_edge: true, ..old }).twist, Twist2::ZERO);
        assert_eq!(
            cart().check(&SafetyInput { twist: turn, ..old }).twist,
            Twist2::ZERO,
            "its corners sweep"
        );
        let on = SafetyInput { twist: Twist2::new(0.1, 0.0), ..old };
        assert_eq!(monitor().check(&on).twist, Twist2::ZERO);
        assert_eq!(monitor().check(&SafetyInput { image: None, ..old }).twist, Twist2::ZERO);
    }

    #[test]
    fn a_disc_turns_before_an_obstacle() {
        let wall = scan(-0.1, 0.01, &[0.2; 21]);
        let report = monitor().check(&SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(0.3, 0.7)) });
        assert_eq!(report.twist, Twist2::new(0.0, 0.7));
        assert!(report.action.to_string().starts_with("stop: an obstacle in the way"), "{}", report.action);
        let away = monitor().check(&SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(-0.1, 0.0)) });
        assert_eq!(away.action, SafetyAction::Pass);
    }

    #[test]
    fn it_leaves_a_wall_within_the_margin() {
        // A wall along x, 5 mm from the disc.
        let distance: f64 = 0.1755 + 0.005;
        let bearing = |i: i32| (10.0 + 2.0 * f64::from(i)).to_radians();
        let ranges: Vec<f64> = (0..80).map(|i| distance / bearing(i).sin()).collect();
        let wall = scan(bearing(0), 2.0_f64.to_radians(), &ranges);
        let check =
            |v, omega| monitor().check(&SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(v, omega)) });
        assert!(check(0.1, 0.0).twist.v > 0.0, "along it: {}", check(0.1, 0.0).action);
        assert!(check(0.1, -0.1).twist.v > 0.0, "away from it: {}", check(0.1, -0.1).action);
        assert!(check(0.1, 0.3).twist.v < 0.03, "into it: {}", check(0.1, 0.3).action);
    }

    fn cart() -> SafetyMonitor {
        let corners = [(0.4, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.4, -0.2)];
        let footprint = Footprint::polygon(corners.iter().map(|&(x, y)| Vector2::new(x, y)).collect());
        SafetyMonitor::new(SafetyConfig::default(), &footprint.unwrap()).unwrap()
    }

    #[test]
    fn a_polygon_passes_a_gap_that_stops_its_disc_and_does_not_turn_there() {
        let half = 0.26_f64;
        let bearing = |i: i32| (-170.0 + 2.0 * f64::from(i)).to_radians();
        let ranges: Vec<f64> = (0..171).map(|i| half / bearing(i).sin().abs().max(1e-3)).collect();
        let walls = scan(bearing(0), 2.0_f64.to_radians(), &ranges);
        let check =
            |v, omega| cart().check(&SafetyInput { scan: seen(&walls), ..fresh(Twist2::new(v, omega)) });
        assert_eq!(check(0.1, 0.0).action, SafetyAction::Pass);
        let turn = check(0.0, 1.5);
        assert!(turn.twist.omega < 0.5 && turn.action != SafetyAction::Pass, "{turn:?}");
        let disc = Footprint::disc(0.4473).unwrap();
        let mut disc = SafetyMonitor::new(SafetyConfig::default(), &disc).unwrap();
        let straight = disc.check(&SafetyInput { scan: seen(&walls), ..fresh(Twist2::new(0.1, 0.0)) });
        assert_eq!(straight.twist.v, 0.0);
    }

    #[test]
    fn a_turn_stops_before_the_corner_meets_the_wall() {
        // A post that the front left corner comes to after some 30 deg.
        let (mut theta, mut rate) = (0.0_f64, 0.0_f64);
        let post = Vector2::new(0.0, 0.44);
        let mut least = f64::INFINITY;
        for _ in 0..400 {
            let at = Pose2::new(0.0, 0.0, theta).inverse().transform(post);
            let scan = scan(at.y.atan2(at.x), 0.01, &[at.norm()]);
            let twist =
                cart().check(&SafetyInput { scan: seen(&scan), ..fresh(Twist2::new(0.0, 2.0)) }).twist;
            // The base follows the command within the monitor's assumption.
            rate = twist.omega.clamp(rate - 3.0 * 0.02, rate + 3.0 * 0.02);
            theta += rate * 0.02;
            let at = Pose2::new(0.0, 0.0, theta).inverse().transform(post);
            least = least.min(cart().footprint.signed_distance(at));
        }
        assert!(least > 0.005 && theta > 0.5, "{least} m left after {theta} rad");
    }

    proptest! {
        #[test]
        fn a_command_is_only_slowed_on_its_own_curve(
            (v, omega) in (-0.7..0.7, -3.0..3.0),
            ranges in prop::collection::vec(0.1..4.0, 40),
        ) {
            let scan = scan(-0.6, 0.03, &ranges);
            let twist = Twist2::new(v, omega);
            let report = monitor().check(&SafetyInput { scan: seen(&scan), ..fresh(twist) });
            let bent = report.twist.omega * twist.v - twist.omega * report.twist.v;
            prop_assert!(report.twist.v.abs() <= v.abs() && report.twist.v * v >= 0.0);
            prop_assert!(report.twist.v == 0.0 || bent.abs() < 1e-9);
            prop_assert!(report.twist.omega.abs() <= omega.abs());
        }
    }
}
