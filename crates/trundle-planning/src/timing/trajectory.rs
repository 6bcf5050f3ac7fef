//! Time along a route within the limits of the drive.
//!
//! Problem: the speed along each curve. Idea: the speed has a ceiling at each point (speed, turn rate, wheel speed, change of curvature,
//! clearance). A pass backward from rest at the end and a pass forward from the start's speed lower the speed until every acceleration is
//! allowed (\[Bobrow85\], on a path with decoupled bounds). Half of the angular acceleration is reserved for the change of curvature, half
//! for the change of speed. Cost: O(samples).

use crate::curve::analytic_curve::{Curve, CurveSample};
use crate::curve::phase::Phase;
use crate::timing::profile::SpeedProfile;
use crate::timing::speeds::{DriveModel, MIN_SAMPLE_PERIOD_S, can_follow_samples};
use crate::timing::turn::time_turn;
use trundle_core::{Pose2, Trajectory, TrajectoryPoint, Twist2};

/// Spacing of the points of the speed profile, m. Source: ours.
const PROFILE_SPACING_M: f64 = 0.01;

/// The trajectory through `phases`: at `v_start` m/s first, at rest between phases and at the end. `ceiling` is the highest speed at a
/// pose, given its surroundings, m/s. Without phases the trajectory has one point.
pub(crate) fn trajectory(
    start: Pose2,
    phases: &[Phase],
    v_start: f64,
    drive: &DriveModel,
    ceiling: impl Fn(Pose2) -> f64,
) -> Trajectory {
    let mut points = vec![TrajectoryPoint { time: 0.0, pose: start, twist: Twist2::ZERO }];
    time_phases(phases, v_start, drive, &ceiling, &mut points);
    Trajectory::new(points).expect(TIMES_RISE)
}

/// Like [`trajectory`], with a stop after `arc` m of the first phase, which must be a curve; and the time of the stop, s. `None` if the
/// robot cannot stop there.
pub(crate) fn trajectory_with_stop(
    start: Pose2,
    phases: &[Phase],
    v_start: f64,
    drive: &DriveModel,
    ceiling: impl Fn(Pose2) -> f64,
    arc: f64,
) -> Option<(Trajectory, f64)> {
    let (Phase::Drive(curve), rest) = phases.split_first()? else { return None };
    let samples = curve.samples(PROFILE_SPACING_M);
    let cut = stop_among(&samples, arc);
    if !can_follow_samples(&samples[..=cut], v_start, drive) {
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

/// The sample of a stop after `arc` m, or just before the end. Between two rests at least one sample is needed, because only that sample
/// has a speed.
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
    drive: &DriveModel,
    ceiling: &impl Fn(Pose2) -> f64,
    points: &mut Vec<TrajectoryPoint>,
) {
    for (i, phase) in phases.iter().enumerate() {
        let v = if i == 0 { v_start } else { 0.0 };
        match phase {
            Phase::Turn { from, angle } => time_turn(*from, *angle, drive, points),
            Phase::Drive(curve) => {
                time_curve(curve, &curve.samples(PROFILE_SPACING_M), v, drive, ceiling, points);
            }
        }
    }
}

/// Whether a robot at `v` m/s can drive the first of `phases` within its limits and stop on it.
pub(crate) fn can_follow(phases: &[Phase], v: f64, drive: &DriveModel) -> bool {
    match phases.first() {
        Some(Phase::Drive(curve)) => can_follow_samples(&curve.samples(PROFILE_SPACING_M), v, drive),
        _ => false,
    }
}

/// Appends samples a period apart over the part of the curve that `samples` cover; the last one exactly at its end. A part without length
/// adds no samples.
fn time_curve(
    curve: &Curve,
    samples: &[CurveSample],
    v_start: f64,
    drive: &DriveModel,
    ceiling: &impl Fn(Pose2) -> f64,
    points: &mut Vec<TrajectoryPoint>,
) {
    let profile = SpeedProfile::new(samples, v_start, drive, ceiling);
    if profile.duration() <= MIN_SAMPLE_PERIOD_S {
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
    let count = ((duration - MIN_SAMPLE_PERIOD_S) / period).floor().max(0.0) as usize;
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
    use crate::timing::config::TimingConfig;
    use trundle_core::{DriveLimits, Vector2};

    fn drive(jerk: Option<f64>) -> DriveModel {
        let config = TimingConfig { jerk, ..TimingConfig::default() };
        DriveModel { limits: DriveLimits::KOBUKI, half_base: 0.115, config }
    }

    fn free(_: Pose2) -> f64 {
        f64::INFINITY
    }

    #[test]
    fn a_stop_anywhere_on_a_curve_keeps_time_and_position_continuous() {
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
                    let (distance, dt) = (pair[0].pose.distance(&pair[1].pose), pair[1].time - pair[0].time);
                    assert!(
                        distance <= DriveLimits::KOBUKI.v * dt + 1e-6,
                        "{arc} m at {v} m/s: {distance} m in {dt} s"
                    );
                }
                assert!(trajectory.end().distance(&Pose2::new(0.3, 0.0, 0.0)) < 1e-9);
            }
        }
        assert!(stops > 4 * 200, "{stops}");
    }

    #[test]
    fn a_curve_without_length_takes_no_time() {
        let here = Vector2::new(1.0, 2.0);
        let phases = [Phase::Drive(Curve::line(here, here + Vector2::new(1e-12, 0.0)))];
        let trajectory = trajectory(Pose2::new(1.0, 2.0, 0.0), &phases, 0.0, &drive(None), free);
        assert_eq!(trajectory.duration(), 0.0);
    }
}
