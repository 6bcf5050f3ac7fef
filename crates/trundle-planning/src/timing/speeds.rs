//! The highest allowed speed along a curve.

use crate::curve::analytic_curve::CurveSample;
use crate::timing::config::TimingConfig;
use trundle_core::{DriveLimits, Pose2};

/// Limits of the speed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DriveModel {
    pub(crate) limits: DriveLimits,
    /// Half the distance between the wheels, m.
    pub(crate) half_base: f64,
    pub(crate) config: TimingConfig,
}

/// Smallest time between two samples, s. Source: ours.
pub(super) const MIN_SAMPLE_PERIOD_S: f64 = 1e-4;
/// Speed that counts as rest, m/s. Source: rounding.
const REST_SPEED_M_S: f64 = 1e-6;
/// Largest ratio of the speed of a moving robot to a ceiling: the noise of a measured twist. A reference on a planned curve never exceeds
/// its ceiling. Source: ours.
const MAX_CEILING_RATIO: f64 = 1.05;

impl DriveModel {
    /// The largest acceleration at a curvature, m/s^2; half of the angular acceleration is available.
    pub(crate) fn acceleration(&self, curvature: f64) -> f64 {
        let turning = self.limits.angular_acceleration / 2.0 / curvature.abs().max(1e-9);
        self.limits.acceleration.min(turning)
    }

    /// The largest speed at a clearance, m/s.
    pub(crate) fn near_obstacles(&self, clearance: f64) -> f64 {
        let TimingConfig { slow_speed, full_speed_clearance, .. } = self.config;
        if clearance >= full_speed_clearance {
            return f64::INFINITY;
        }
        let slow = slow_speed.min(self.limits.v);
        slow + (self.limits.v - slow) * (clearance / full_speed_clearance).max(0.0)
    }
}

/// The speed at each sample, m/s: `v_start` at the first, 0 at the last. If `v_start` exceeds a ceiling, the robot brakes as hard as
/// allowed, and harder only if the curve is too short for a stop. A limit also applies `window` m before and after its place.
pub(super) fn speeds(
    samples: &[CurveSample],
    v_start: f64,
    drive: &DriveModel,
    ceiling: impl Fn(Pose2) -> f64,
    window: f64,
) -> Vec<f64> {
    let mut v = ceilings(samples, drive, ceiling);
    let mut gain = gains(samples, drive);
    if window > 0.0 {
        v = minimum_around(samples, &v, window);
        let accelerations: Vec<f64> = samples.windows(2).map(|pair| acceleration(pair, drive)).collect();
        let min = minimum_around(&samples[1..], &accelerations, window);
        gain = samples.windows(2).zip(min).map(|(pair, a)| 2.0 * distance(pair) * a).collect();
    }
    let last = v.len() - 1;
    v[last] = 0.0;
    for i in (0..last).rev() {
        v[i] = v[i].min((v[i + 1] * v[i + 1] + gain[i]).sqrt());
    }
    v[0] = v_start;
    for i in 1..=last {
        let squared = v[i - 1] * v[i - 1];
        v[i] = v[i].min((squared + gain[i - 1]).sqrt()).max((squared - gain[i - 1]).max(0.0).sqrt());
    }
    if v[last] > REST_SPEED_M_S {
        stop_at_end(&mut v, samples);
    }
    v[last] = 0.0;
    v
}

/// For each value the minimum of those within `window` m.
fn minimum_around(samples: &[CurveSample], values: &[f64], window: f64) -> Vec<f64> {
    let mut first = 0;
    let min = |i: usize| {
        while samples[first].arc < samples[i].arc - window {
            first += 1;
        }
        let near = samples[first..].iter().zip(&values[first..]);
        near.take_while(|(sample, _)| sample.arc <= samples[i].arc + window)
            .fold(f64::INFINITY, |min, (_, value)| min.min(*value))
    };
    (0..values.len()).map(min).collect()
}

/// Whether braking as hard as allowed from `v_start` stays below every ceiling of the drive, and ends at rest.
pub(super) fn can_follow_samples(samples: &[CurveSample], v_start: f64, drive: &DriveModel) -> bool {
    let ceilings = ceilings(samples, drive, |_| f64::INFINITY);
    let mut squared = v_start * v_start;
    for (gain, ceiling) in gains(samples, drive).iter().zip(&ceilings) {
        if squared > (MAX_CEILING_RATIO * ceiling).powi(2) {
            return false;
        }
        squared = (squared - gain).max(0.0);
    }
    squared <= REST_SPEED_M_S
}

/// Largest change of the squared speed between neighbouring samples, m^2/s^2.
fn gains(samples: &[CurveSample], drive: &DriveModel) -> Vec<f64> {
    samples.windows(2).map(|pair| 2.0 * distance(pair) * acceleration(pair, drive)).collect()
}

fn distance(pair: &[CurveSample]) -> f64 {
    pair[1].arc - pair[0].arc
}

fn acceleration(pair: &[CurveSample], drive: &DriveModel) -> f64 {
    drive.acceleration(pair[0].curvature.abs().max(pair[1].curvature.abs()))
}

fn ceilings(samples: &[CurveSample], drive: &DriveModel, ceiling: impl Fn(Pose2) -> f64) -> Vec<f64> {
    let around: Vec<f64> = samples.iter().map(|sample| ceiling(sample.pose)).collect();
    let mut v: Vec<f64> = samples
        .iter()
        .enumerate()
        .map(|(i, sample)| {
            let beside = &around[i.saturating_sub(1)..(i + 2).min(around.len())];
            let curvature = sample.curvature.abs();
            let limits = &drive.limits;
            limits
                .v
                .min(limits.omega / curvature.max(1e-9))
                .min(limits.wheel_speed / (1.0 + drive.half_base * curvature))
                .min(beside.iter().fold(f64::INFINITY, |min, v| min.min(*v)))
        })
        .collect();
    for (i, pair) in samples.windows(2).enumerate() {
        let change = (pair[1].curvature - pair[0].curvature).abs() / distance(pair);
        let ceiling = (drive.limits.angular_acceleration / 2.0 / change.max(1e-9)).sqrt();
        v[i] = v[i].min(ceiling);
        v[i + 1] = v[i + 1].min(ceiling);
    }
    v
}

/// Constant deceleration from the first speed to rest at the end.
fn stop_at_end(v: &mut [f64], samples: &[CurveSample]) {
    let begin = samples[0].arc;
    let length = samples[samples.len() - 1].arc - begin;
    let first = v[0];
    for (v, sample) in v.iter_mut().zip(samples) {
        *v = v.min(first * (1.0 - (sample.arc - begin) / length).max(0.0).sqrt());
    }
}
