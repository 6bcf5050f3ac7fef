//! Timing of a turn in place.

use crate::timing::speeds::{DriveModel, MIN_SAMPLE_PERIOD_S};
use trundle_core::{Pose2, TrajectoryPoint, Twist2};

/// Appends a turn by `angle` rad from `from`, a period apart, the last sample exactly at its end.
pub(super) fn time_turn(from: Pose2, angle: f64, drive: &DriveModel, points: &mut Vec<TrajectoryPoint>) {
    let begin = points.last().map_or(0.0, |point| point.time);
    let profile = TurnProfile::new(angle.abs(), drive);
    let sign = angle.signum();
    let at = |turned: f64, rate: f64, time: f64| TrajectoryPoint {
        time: begin + time,
        pose: Pose2::new(from.x, from.y, from.theta + sign * turned),
        twist: Twist2::new(0.0, sign * rate),
    };
    points.pop();
    points.push(at(0.0, 0.0, 0.0));
    let duration = profile.duration();
    let count = ((duration - MIN_SAMPLE_PERIOD_S) / drive.config.period).floor().max(0.0) as usize;
    for k in 1..=count {
        let time = k as f64 * drive.config.period;
        let (turned, rate) = profile.at(time);
        points.push(at(turned, rate, time));
    }
    points.push(at(angle.abs(), 0.0, duration));
}

/// A trapezoid of turn rate over time.
struct TurnProfile {
    angle: f64,
    rate: f64,
    acceleration: f64,
}

impl TurnProfile {
    fn new(angle: f64, drive: &DriveModel) -> Self {
        let acceleration = drive.limits.angular_acceleration;
        let rate = drive.limits.omega.min(drive.limits.wheel_speed / drive.half_base);
        Self { angle, rate: rate.min((angle * acceleration).sqrt()), acceleration }
    }

    fn duration(&self) -> f64 {
        self.angle / self.rate + self.rate / self.acceleration
    }

    /// Angle, rad, and turn rate, rad/s.
    fn at(&self, time: f64) -> (f64, f64) {
        let left = self.duration() - time;
        let ramp = self.rate / self.acceleration;
        if time < ramp {
            (self.acceleration * time * time / 2.0, self.acceleration * time)
        } else if left < ramp {
            (self.angle - self.acceleration * left * left / 2.0, self.acceleration * left)
        } else {
            (self.rate * (time - ramp / 2.0), self.rate)
        }
    }
}
