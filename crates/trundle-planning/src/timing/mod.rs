//! Time along a route, within what the drive can do.
//!
//! Problem: how fast along each curve. Idea: the speed has a ceiling at each point (speed, turn rate, wheel rim,
//! curvature change, room); a pass backward from rest at the end and a pass forward from the start's speed lower it until
//! every acceleration is allowed (Bobrow et al., IJRR 4(3), 1985, on a path with decoupled bounds). Half of the angular
//! acceleration is set aside for the change of curvature, half for the change of speed. Cost: O(samples).

mod config;
mod profile;
mod speeds;
mod turn;

pub use config::TimingConfig;
pub(crate) use speeds::Drive;

use crate::curve::{Curve, CurveSample};
use crate::route::Phase;
use crate::timing::profile::Profile;
use trundle_core::{Pose2, Trajectory, TrajectoryPoint, Twist2};

/// Spacing of the points that get a speed, m.
const SPACING: f64 = 0.01;
/// Two samples are never nearer than this, s.
const LEAST_GAP: f64 = 1e-4;

/// The trajectory through `phases`: at `v_start` m/s first, at rest between phases and at the end. `ceiling` says the
/// highest speed at a pose for what surrounds it, m/s. A trajectory of one point where there is nothing to do.
pub(crate) fn trajectory(
    start: Pose2,
    phases: &[Phase],
    v_start: f64,
    drive: &Drive,
    ceiling: impl Fn(Pose2) -> f64,
) -> Trajectory {
    let mut points = vec![TrajectoryPoint { time: 0.0, pose: start, twist: Twist2::ZERO }];
    time_phases(phases, v_start, drive, &ceiling, &mut points);
    Trajectory::new(points).expect(TIMES_RISE)
}

/// Like [`trajectory`], with a stop `arc` m along the first phase, which must be a curve; and when the robot stands there, s.
/// `None` where it cannot stop there.
pub(crate) fn trajectory_with_stop(
    start: Pose2,
    phases: &[Phase],
    v_start: f64,
    drive: &Drive,
    ceiling: impl Fn(Pose2) -> f64,
    arc: f64,
) -> Option<(Trajectory, f64)> {
    let (Phase::Drive(curve), rest) = phases.split_first()? else { return None };
    let samples = curve.samples(SPACING);
    let cut = stop_among(&samples, arc);
    if !speeds::can_follow(&samples[..=cut], v_start, drive) {
        return None;
    }
    let mut points = vec![TrajectoryPoint { time: 0.0, pose: start, twist: Twist2::ZERO }];
    time_curve(curve, &samples[..=cut], v_start, drive, &ceiling, &mut points);
    let stands = points.last().map_or(0.0, |point| point.time);
    if cut + 1 < samples.len() {
        time_curve(curve, &samples[cut..], 0.0, drive, &ceiling, &mut points);
    }
    time_phases(rest, 0.0, drive, &ceiling, &mut points);
    Some((Trajectory::new(points).expect(TIMES_RISE), stands))
}

/// The sample at which a robot stops `arc` m along, or just before the end. From rest to rest there is at least one sample on the way:
/// only there has it any speed.
fn stop_among(samples: &[CurveSample], arc: f64) -> usize {
    let last = samples.len() - 1;
    match samples.partition_point(|sample| sample.arc < arc).clamp(2.min(last), last) {
        next_to_last if next_to_last + 1 == last => next_to_last.saturating_sub(1).max(1),
        cut => cut,
    }
}

const TIMES_RISE: &str = "invariant: times rise from 0 and numbers are finite";

fn time_phases(
    phases: &[Phase],
    v_start: f64,
    drive: &Drive,
    ceiling: &impl Fn(Pose2) -> f64,
    points: &mut Vec<TrajectoryPoint>,
) {
    for (i, phase) in phases.iter().enumerate() {
        let v = if i == 0 { v_start } else { 0.0 };
        match phase {
            Phase::Turn { from, angle } => turn::time_turn(*from, *angle, drive, points),
            Phase::Drive(curve) => {
                time_curve(curve, &curve.samples(SPACING), v, drive, ceiling, points);
            }
        }
    }
}

/// Whether a robot at `v` m/s can drive the first of `phases` within its limits, and come to rest on it.
pub(crate) fn can_follow(phases: &[Phase], v: f64, drive: &Drive) -> bool {
    match phases.first() {
        Some(Phase::Drive(curve)) => speeds::can_follow(&curve.samples(SPACING), v, drive),
        _ => false,
    }
}

/// Appends samples a period apart over the part of the curve that `samples` cover; the last one exactly at its end. Nothing for a
/// part of no length.
fn time_curve(
    curve: &Curve,
    samples: &[CurveSample],
    v_start: f64,
    drive: &Drive,
    ceiling: &impl Fn(Pose2) -> f64,
    points: &mut Vec<TrajectoryPoint>,
) {
    let profile = Profile::new(samples, v_start, drive, ceiling);
    if profile.duration() <= LEAST_GAP {
        return;
    }
    let begin = points.last().map_or(0.0, |point| point.time);
    let at = |s: f64, v: f64, time: f64| {
        let (pose, curvature) = curve.pose_and_curvature(s);
        TrajectoryPoint { time: begin + time, pose, twist: Twist2::new(v, curvature * v) }
    };
    points.pop();
    points.push(at(samples[0].s, profile.at(0.0).1, 0.0));
    let (duration, period) = (profile.duration(), drive.config.period);
    let mut after = 1;
    let count = ((duration - LEAST_GAP) / period).floor().max(0.0) as usize;
    points.reserve(count + 1);
    for k in 1..=count {
        let time = k as f64 * period;
        let (arc, v) = profile.at(time);
        while after + 1 < samples.len() && samples[after].arc < arc {
            after += 1;
        }
        let (low, high) = (samples[after - 1], samples[after]);
        let share = ((arc - low.arc) / (high.arc - low.arc).max(1e-12)).clamp(0.0, 1.0);
        points.push(at(low.s + (high.s - low.s) * share, v, time));
    }
    points.push(at(samples[samples.len() - 1].s, 0.0, duration));
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{DriveLimits, Vector2};

    fn drive(jerk: Option<f64>) -> Drive {
        let config = TimingConfig { jerk, ..TimingConfig::default() };
        Drive { limits: DriveLimits::KOBUKI, half_base: 0.115, config }
    }

    fn free(_: Pose2) -> f64 {
        f64::INFINITY
    }

    #[test]
    fn wherever_on_a_curve_it_stops_time_goes_on_and_nothing_jumps() {
        let (start, curve) = (Pose2::IDENTITY, Curve::line(Vector2::zeros(), Vector2::new(0.3, 0.0)));
        let phases = [Phase::Drive(curve), Phase::Turn { from: Pose2::new(0.3, 0.0, 0.0), angle: 0.5 }];
        let mut stops = 0;
        for (v, arc) in [0.0, 0.2].iter().flat_map(|v| (0..=310).map(|mm| (*v, f64::from(mm) / 1000.0))) {
            for jerk in [None, Some(3.0)] {
                let drive = drive(jerk);
                let Some((trajectory, stands)) = trajectory_with_stop(start, &phases, v, &drive, free, arc)
                else {
                    continue;
                };
                stops += 1;
                let there = trajectory.at(stands);
                assert!((there.pose.x - arc.min(0.3)).abs() < 0.021, "{arc} m at {v} m/s: {:?}", there.pose);
                assert!(there.twist.v.abs() < 1e-9);
                for pair in trajectory.points().windows(2) {
                    let (way, dt) = (pair[0].pose.distance(&pair[1].pose), pair[1].time - pair[0].time);
                    assert!(
                        way <= DriveLimits::KOBUKI.v * dt + 1e-6,
                        "{arc} m at {v} m/s: {way} m in {dt} s"
                    );
                }
                assert!(trajectory.end().distance(&Pose2::new(0.3, 0.0, 0.0)) < 1e-9);
            }
        }
        assert!(stops > 4 * 200, "{stops}");
    }

    #[test]
    fn a_curve_of_no_length_takes_no_time() {
        let here = Vector2::new(1.0, 2.0);
        let phases = [Phase::Drive(Curve::line(here, here + Vector2::new(1e-12, 0.0)))];
        let trajectory = trajectory(Pose2::new(1.0, 2.0, 0.0), &phases, 0.0, &drive(None), free);
        assert_eq!(trajectory.duration(), 0.0);
    }
}
