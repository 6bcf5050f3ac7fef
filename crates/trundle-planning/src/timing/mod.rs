//! Time along a route, within what the drive can do.
//!
//! Problem: how fast along each curve. Idea: the speed has a ceiling at each point (speed, turn rate, wheel rim,
//! curvature change, room); a pass backward from rest at the end and a pass forward from the start's speed lower it until
//! every acceleration is allowed (Bobrow et al., IJRR 4(3), 1985, on a path with decoupled bounds). Half of the angular
//! acceleration is set aside for the change of curvature, half for the change of speed. Cost: O(samples).

mod config;
mod speeds;
mod turn;

pub use config::TimingConfig;
pub(crate) use speeds::Drive;

use crate::curve::{Curve, CurveSample};
use crate::route::Phase;
use crate::timing::speeds::speeds;
use trundle_core::{Pose2, Trajectory, TrajectoryPoint, Twist2, Vector2};

/// Spacing of the points that get a speed, m.
const SPACING: f64 = 0.01;
/// Two samples are never nearer than this, s.
const LEAST_GAP: f64 = 1e-4;

/// The trajectory through `phases`: at `v_start` m/s first, at rest between phases and at the end. `clearance` says the
/// room at a point, m. A trajectory of one point where there is nothing to do.
pub(crate) fn trajectory(
    start: Pose2,
    phases: &[Phase],
    v_start: f64,
    drive: &Drive,
    clearance: impl Fn(Vector2) -> f64,
) -> Trajectory {
    let mut points = vec![TrajectoryPoint { time: 0.0, pose: start, twist: Twist2::ZERO }];
    for (i, phase) in phases.iter().enumerate() {
        let v = if i == 0 { v_start } else { 0.0 };
        match phase {
            Phase::Turn { from, angle } => turn::time_turn(*from, *angle, drive, &mut points),
            Phase::Drive(curve) => {
                let samples = curve.samples(SPACING);
                let speeds = speeds(&samples, v, drive, &clearance);
                time_curve(curve, &samples, &speeds, drive.config.period, &mut points);
            }
        }
    }
    Trajectory::new(points).expect("invariant: times rise from 0 and numbers are finite")
}

/// Whether a robot at `v` m/s can drive the first of `phases` within its limits, and come to rest on it.
pub(crate) fn can_follow(phases: &[Phase], v: f64, drive: &Drive) -> bool {
    match phases.first() {
        Some(Phase::Drive(curve)) => speeds::can_follow(&curve.samples(SPACING), v, drive),
        _ => false,
    }
}

/// Appends samples a period apart; the last one exactly at the curve's end.
fn time_curve(
    curve: &Curve,
    samples: &[CurveSample],
    speeds: &[f64],
    period: f64,
    points: &mut Vec<TrajectoryPoint>,
) {
    let begin = points.last().map_or(0.0, |point| point.time);
    let at = |s: f64, v: f64, time: f64| {
        let (pose, curvature) = curve.pose_and_curvature(s);
        TrajectoryPoint { time: begin + time, pose, twist: Twist2::new(v, curvature * v) }
    };
    points.pop();
    points.push(at(0.0, speeds[0], 0.0));
    let mut next = period;
    let mut now = 0.0;
    for (pair, v) in samples.windows(2).zip(speeds.windows(2)) {
        let way = pair[1].arc - pair[0].arc;
        let duration = 2.0 * way / (v[0] + v[1]);
        let acceleration = (v[1] - v[0]) / duration;
        while next < now + duration {
            let t = next - now;
            let share = (v[0] * t + acceleration * t * t / 2.0) / way;
            let s = pair[0].s + (pair[1].s - pair[0].s) * share.clamp(0.0, 1.0);
            points.push(at(s, v[0] + acceleration * t, next));
            next += period;
        }
        now += duration;
    }
    finish(points, at(curve.span(), speeds[speeds.len() - 1], now), begin);
}

/// Puts the last sample, in place of one that is hardly earlier.
fn finish(points: &mut Vec<TrajectoryPoint>, last: TrajectoryPoint, begin: f64) {
    if points.last().is_some_and(|point| point.time > begin && last.time - point.time < LEAST_GAP) {
        points.pop();
    }
    points.push(last);
}
