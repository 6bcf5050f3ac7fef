//! The law of the monitor: the footprint swept by the twist that passes, until the robot is at rest, meets no known obstacle.
//!
//! Generated cases against a checker that shares no code with the monitor: it drives the outline in small steps and measures distances to
//! its sides.

use super::*;
use crate::safety::hold::MotionHold;
use crate::safety::obstacles::SafetyMemory;
use crate::safety::safety_input::is_stale;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid};

/// Number of generated cases.
const CASE_COUNT: u64 = 1_000_000;
/// Poses along a swept path at which the checker measures.
const SAMPLES_PER_PATH: usize = 24;
/// Lower left corner of the map, m.
const MAP_ORIGIN_M: Vector2 = Vector2::new(-0.7, 0.4);
/// Rounding of the checker, m.
const TOLERANCE_M: f64 = 1e-6;

/// A fixed sequence of numbers (SplitMix64).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in `low..high`.
    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }

    fn pose(&mut self, reach: f64) -> Pose2 {
        Pose2::new(self.within(-reach, reach), self.within(-reach, reach), self.within(-3.2, 3.2))
    }

    /// Zero in one of three cases, small in another.
    fn rate(&mut self, max: f64) -> f64 {
        match self.below(3) {
            0 => 0.0,
            1 => self.within(-max, max) / 20.0,
            _ => self.within(-max, max),
        }
    }
}

/// A generated state of the robot and its sensors.
struct Case {
    config: SafetyConfig,
    footprint: Footprint,
    twist: Twist2,
    scan: Scan,
    odom: (Pose2, Pose2),
    grid: OccupancyGrid,
    unconfirmed: Vec<Vector2>,
    map_from_base: Pose2,
    image_age: f64,
    wheels_age: f64,
    flags: u64,
}

fn config(draw: &mut Draw) -> SafetyConfig {
    if draw.below(2) == 0 {
        return SafetyConfig::default();
    }
    let side_margin = draw.within(0.0, 0.05);
    SafetyConfig {
        deceleration: draw.within(0.1, 3.0),
        angular_deceleration: draw.within(0.3, 10.0),
        latency: draw.within(0.0, 0.5),
        stop_margin: draw.within(0.0, 0.1),
        side_margin,
        slow_margin: side_margin + draw.within(0.0, 0.1),
        memory_reach: draw.within(0.2, 2.0),
        ..SafetyConfig::default()
    }
}

fn footprint(draw: &mut Draw) -> Footprint {
    match draw.below(4) {
        0 => Footprint::KOBUKI,
        1 => Footprint::disc(draw.within(0.08, 0.5)).unwrap(),
        2 => {
            let (front, back, side) = (draw.within(0.1, 0.6), draw.within(0.05, 0.4), draw.within(0.1, 0.35));
            polygon(&[(front, side), (-back, side), (-back, -side), (front, -side)])
        }
        _ => {
            // Corners on an ellipse: convex in any number.
            let (a, b) = (draw.within(0.15, 0.5), draw.within(0.15, 0.4));
            let count = 3 + draw.below(5);
            let angle = |i: u64| std::f64::consts::TAU * i as f64 / count as f64;
            let corners: Vec<_> = (0..count).map(|i| (a * angle(i).cos(), b * angle(i).sin())).collect();
            polygon(&corners)
        }
    }
}

fn polygon(corners: &[(f64, f64)]) -> Footprint {
    Footprint::polygon(corners.iter().map(|&(x, y)| Vector2::new(x, y)).collect()).unwrap()
}

fn case(index: u64) -> Case {
    let draw = &mut Draw(index.wrapping_mul(0xA24B_AED4_963E_E407));
    let beams = 1 + draw.below(6);
    let ranges: Vec<f64> = (0..beams).map(|_| draw.within(0.05, 1.6)).collect();
    let odom_at_scan = draw.pose(3.0);
    let moved = Pose2::new(draw.within(-0.1, 0.1), draw.within(-0.02, 0.02), draw.within(-0.2, 0.2));
    let in_map = Vector2::new(draw.within(0.5, 1.5), draw.within(0.5, 1.5)) + MAP_ORIGIN_M;
    let map_from_base = Pose2::new(in_map.x, in_map.y, draw.within(-3.2, 3.2));
    let geometry = GridGeometry::new(0.1, MAP_ORIGIN_M, 20, 20).unwrap();
    let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
    for _ in 0..draw.below(4) {
        let (col, row) = (draw.below(20) as usize, draw.below(20) as usize);
        grid.set(CellIndex { col, row }, Cell::Occupied);
    }
    let unconfirmed = (0..draw.below(3))
        .map(|_| Vector2::new(draw.within(0.0, 2.0), draw.within(0.0, 2.0)) + MAP_ORIGIN_M)
        .collect();
    Case {
        config: config(draw),
        footprint: footprint(draw),
        twist: Twist2::new(draw.rate(1.5), draw.rate(4.0)),
        scan: scan(draw.within(-3.1, 3.1), 0.9, &ranges),
        odom: (odom_at_scan, odom_at_scan * moved),
        grid,
        unconfirmed,
        map_from_base,
        image_age: draw.within(-0.3, 1.0),
        wheels_age: draw.within(-0.3, 0.22),
        flags: draw.next(),
    }
}

impl Case {
    fn input(&self) -> SafetyInput<'_> {
        let now = Stamp::default().after(100.0);
        let flag = |bit: u64, one_of: u64| (self.flags >> bit).is_multiple_of(one_of);
        SafetyInput {
            now,
            twist: self.twist,
            scan: self.has_scan().then_some(SafetyScan {
                scan: &self.scan,
                odom_at_scan: self.odom.0,
                odom_now: self.odom.1,
            }),
            memory: Some(SafetyMemory {
                grid: &self.grid,
                unconfirmed: &self.unconfirmed,
                map_from_base: self.map_from_base,
            }),
            touched: flag(0, 8),
            over_edge: flag(8, 16),
            hold: flag(16, 64).then_some(MotionHold::WheelDrop),
            image: (!flag(24, 32)).then(|| now.after(-self.image_age)),
            wheels: Some(now.after(-self.wheels_age)),
            motion: match (self.flags >> 32) % 16 {
                0 => MotionSense::Sight,
                1 => MotionSense::Nothing,
                _ => MotionSense::Wheels,
            },
            station: None,
        }
    }

    fn has_scan(&self) -> bool {
        !(self.flags >> 40).is_multiple_of(16)
    }

    /// Every known obstacle within the range that the configuration names: centre in the base frame, radius, m.
    fn obstacles(&self) -> Vec<(Vector2, f64)> {
        let (at_scan, now) = self.odom;
        let hits = self
            .scan
            .hits()
            .filter(|_| self.has_scan())
            .map(|hit| (now.inverse().transform(at_scan.transform(hit)), 0.0));
        let to_base = |at: Vector2| self.map_from_base.inverse().transform(at);
        let mut memory: Vec<_> = self.unconfirmed.iter().map(|at| (to_base(*at), 0.0)).collect();
        for (row, col) in (0..20).flat_map(|row| (0..20).map(move |col| (row, col))) {
            if self.grid.get(CellIndex { col, row }) == Cell::Occupied {
                let centre = Vector2::new((col as f64 + 0.5) * 0.1, (row as f64 + 0.5) * 0.1);
                memory.push((to_base(MAP_ORIGIN_M + centre), 0.05));
            }
        }
        let reach = self.config.memory_reach + self.footprint.circumscribed_radius();
        memory.retain(|(at, _)| at.norm() <= reach);
        hits.chain(memory).collect()
    }

    /// Time at the twist that sweeps the path until the robot is at rest, s.
    fn sweep(&self, twist: Twist2) -> f64 {
        // Without a view and out of a contact the age of the image does not count: docs/explanation/safety-case.md.
        let input = self.input();
        let is_blind = is_stale(self.image_age, self.config.image_timeout)
            || input.image.is_none()
            || input.motion == MotionSense::Nothing;
        let backs_out = input.touched || input.over_edge;
        let age = if is_blind || backs_out { 0.0 } else { self.image_age };
        let reaction = self.config.latency.max(age + 0.12);
        let braking = (twist.v.abs() / self.config.deceleration)
            .max(twist.omega.abs() / self.config.angular_deceleration);
        reaction + braking / 2.0
    }
}

/// Distance of a point of the base frame from the outline, m; negative inside.
fn gap(footprint: &Footprint, p: Vector2) -> f64 {
    match footprint {
        Footprint::Disc { radius } => p.norm() - radius,
        Footprint::Polygon { corners } => {
            let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
            let turn = |(a, b): (&Vector2, &Vector2)| (b - a).perp(&(p - a));
            let inside = sides().all(|side| turn(side) >= 0.0) || sides().all(|side| turn(side) <= 0.0);
            let to_side = |(a, b): (&Vector2, &Vector2)| {
                let along = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                (p - (a + (b - a) * along)).norm()
            };
            let distance = sides().map(to_side).fold(f64::INFINITY, f64::min);
            if inside { -distance } else { distance }
        }
    }
}

/// Whether the twist that passes meets no obstacle that the footprint does not overlap at the start.
fn holds(case: &Case, twist: Twist2) -> Result<(), String> {
    let duration = case.sweep(twist);
    for (at, extent) in case.obstacles() {
        if gap(&case.footprint, at) - extent <= TOLERANCE_M {
            continue;
        }
        for sample in 1..=SAMPLES_PER_PATH {
            let pose = Pose2::IDENTITY.advance(twist, duration * sample as f64 / SAMPLES_PER_PATH as f64);
            let gap = gap(&case.footprint, pose.inverse().transform(at)) - extent;
            if gap < -TOLERANCE_M {
                let (command, footprint) = (case.twist, &case.footprint);
                return Err(format!("{command:?} passed as {twist:?}, {footprint:?}: {at} m, {gap} m"));
            }
        }
    }
    Ok(())
}

/// Cases that move, and whether every one of them holds.
fn count_moving(indices: std::ops::Range<u64>, mut pass: impl FnMut(&Case) -> Twist2) -> Result<u64, String> {
    let mut moving = 0;
    for index in indices {
        let case = case(index);
        let twist = pass(&case);
        if twist != Twist2::ZERO {
            moving += 1;
            holds(&case, twist).map_err(|error| format!("case {index}: {error}"))?;
        }
    }
    Ok(moving)
}

/// The twist that the monitor passes.
fn monitored(case: &Case) -> Twist2 {
    SafetyMonitor::new(case.config.clone(), &case.footprint).unwrap().check(&case.input()).twist
}

fn check_part(part: u64) {
    let indices = part * CASE_COUNT / 4..(part + 1) * CASE_COUNT / 4;
    let moving = count_moving(indices, monitored).unwrap_or_else(|error| panic!("{error}"));
    assert!(moving > CASE_COUNT / 16, "{moving} cases move: the others show nothing");
}

#[test]
fn the_swept_footprint_is_free_first_quarter() {
    check_part(0);
}

#[test]
fn the_swept_footprint_is_free_second_quarter() {
    check_part(1);
}

#[test]
fn the_swept_footprint_is_free_third_quarter() {
    check_part(2);
}

#[test]
fn the_swept_footprint_is_free_last_quarter() {
    check_part(3);
}

#[test]
fn commands_that_pass_unchecked_break_the_law() {
    assert!(count_moving(0..2_000, |case| case.twist).is_err());
    let faster = |case: &Case| {
        let twist = monitored(case);
        Twist2::new(twist.v * 1.3, twist.omega * 1.3)
    };
    assert!(count_moving(0..20_000, faster).is_err(), "a third more speed is found");
}
