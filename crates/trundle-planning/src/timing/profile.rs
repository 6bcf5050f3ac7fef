//! Speed over time along one curve, with an optional bound of the jerk.
//!
//! Problem: the fastest speed profile jumps in acceleration. Idea: average the motion over a window of T = 2 a / jerk seconds. The mean of
//! motions with acceleration at most a has a jerk of at most 2 a / T. The averaged motion is never faster than the fastest in its window:
//! limits that hold for the distance covered in T hold for the mean. The averaged motion ends at the same place, T later. Cost: O(samples).

use crate::curve::analytic_curve::CurveSample;
use crate::timing::speeds::{DriveModel, speeds};
use trundle_core::Pose2;

/// Position on a curve and speed at any time.
#[derive(Debug)]
pub(super) struct SpeedProfile {
    knots: Vec<Knot>,
    /// Length of the averaging window, s; 0: none.
    window: f64,
    /// Start of the window before the queried time, s.
    lead: f64,
}

#[derive(Debug, Clone, Copy)]
struct Knot {
    time: f64,
    arc: f64,
    v: f64,
    /// Acceleration after the knot, m/s^2.
    a: f64,
    /// The integral of `arc` over time.
    area: f64,
}

impl SpeedProfile {
    /// The profile from `v_start` m/s to rest. A moving robot without the space to hold its speed for half a window gets a profile without
    /// a bound of the jerk.
    pub(super) fn new(
        samples: &[CurveSample],
        v_start: f64,
        drive: &DriveModel,
        ceiling: impl Fn(Pose2) -> f64,
    ) -> Self {
        let Some(jerk) = drive.config.jerk else {
            return Self::without_jerk_bound(samples, &speeds(samples, v_start, drive, ceiling, 0.0));
        };
        let window = 2.0 * drive.limits.acceleration / jerk;
        let reach = drive.limits.v.max(v_start) * window;
        if v_start == 0.0 {
            let without_jerk_bound =
                Self::without_jerk_bound(samples, &speeds(samples, 0.0, drive, ceiling, reach));
            return Self { window, lead: window, ..without_jerk_bound };
        }
        let hold = v_start * window / 2.0;
        let from = samples.partition_point(|sample| sample.arc < samples[0].arc + hold);
        if from + 1 < samples.len() {
            let after = speeds(&samples[from..], v_start, drive, &ceiling, reach);
            let free = speeds(samples, v_start, drive, &ceiling, reach);
            // The speed is constant for the first segment if no limit reduces it there.
            if free[..=from].iter().all(|v| *v >= v_start - 1e-9) {
                let held = std::iter::repeat_n(v_start, from).chain(after).collect::<Vec<_>>();
                return Self { window, lead: window / 2.0, ..Self::without_jerk_bound(samples, &held) };
            }
        }
        Self::without_jerk_bound(samples, &speeds(samples, v_start, drive, ceiling, 0.0))
    }

    /// Constant acceleration between samples.
    fn without_jerk_bound(samples: &[CurveSample], speeds: &[f64]) -> Self {
        let first = Knot { time: 0.0, arc: samples[0].arc, v: speeds[0], a: 0.0, area: 0.0 };
        let mut knots = Vec::with_capacity(samples.len());
        knots.push(first);
        for (pair, v) in samples.windows(2).zip(speeds.windows(2)) {
            let distance = pair[1].arc - pair[0].arc;
            if distance <= 0.0 || v[0] + v[1] <= 0.0 {
                continue;
            }
            let duration = 2.0 * distance / (v[0] + v[1]);
            let last = knots.last_mut().expect("invariant: there is a first knot");
            last.a = (v[1] - v[0]) / duration;
            let area = last.area_after(duration);
            let next = Knot { time: last.time + duration, arc: pair[1].arc, v: v[1], a: 0.0, area };
            knots.push(next);
        }
        Self { knots, window: 0.0, lead: 0.0 }
    }

    /// Time of rest, s.
    pub(super) fn duration(&self) -> f64 {
        self.knots[self.knots.len() - 1].time + self.lead
    }

    /// Distance, m, and speed, m/s.
    pub(super) fn at(&self, time: f64) -> (f64, f64) {
        if self.window == 0.0 {
            let (knot, t) = self.knot(time);
            return (knot.arc_after(t), knot.v + knot.a * t);
        }
        let (begin, end) = (time - self.lead, time - self.lead + self.window);
        let ((a, s), (b, t)) = (self.knot(begin), self.knot(end));
        let arc = (b.area_after(t) - a.area_after(s)) / self.window;
        (arc, ((b.arc_after(t) - a.arc_after(s)) / self.window).max(0.0))
    }

    /// The knot before a time, and the time since: constant speed before the first, rest after the last.
    fn knot(&self, time: f64) -> (Knot, f64) {
        let after = self.knots.partition_point(|knot| knot.time <= time);
        if after == 0 {
            let first = self.knots[0];
            return (Knot { a: 0.0, ..first }, time);
        }
        let mut knot = self.knots[after - 1];
        if after == self.knots.len() {
            (knot.v, knot.a) = (0.0, 0.0);
        }
        (knot, time - knot.time)
    }
}

impl Knot {
    fn arc_after(&self, t: f64) -> f64 {
        self.arc + self.v * t + self.a * t * t / 2.0
    }

    fn area_after(&self, t: f64) -> f64 {
        self.area + self.arc * t + self.v * t * t / 2.0 + self.a * t * t * t / 6.0
    }
}
