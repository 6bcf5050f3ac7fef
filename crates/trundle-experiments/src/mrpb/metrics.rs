//! The MRPB benchmark's metrics of one run: safety, efficiency, smoothness, and computation.

use crate::laser_run::{LaserRun, Moment};
use serde::{Deserialize, Serialize};

/// The benchmark's metrics of one run (Wen et al., MRPB 1.0, IROS 2021), in four groups.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Metrics {
    /// Safety: minimum clearance, m.
    pub min_clearance: f64,
    /// Safety: fraction of the time nearer to an obstacle than [`NEAR_OBSTACLE_M`], 0 to 1.
    pub time_near: f64,
    /// Efficiency: time from start to goal, s.
    pub time: f64,
    /// Efficiency: distance driven, m.
    pub length: f64,
    /// Smoothness of the path: mean square of the second difference of the position, m^2.
    pub path_roughness: f64,
    /// Smoothness of the speed: mean change of the commanded speed over time, m/s^2.
    pub speed_roughness: f64,
    /// CPU time of a control cycle (odometry, supervision, planning, control, safety), ms: mean, median, 99th percentile, maximum.
    pub cycle_ms: [f64; 4],
}

/// Clearance below which an obstacle counts as near \[m\]. Source: ours.
pub const NEAR_OBSTACLE_M: f64 = 0.1;
/// Stride of the moments for smoothness: 25 Hz of 50 Hz. Source: MRPB 1.0.
const SMOOTHNESS_STRIDE: usize = 2;

impl Metrics {
    /// The metrics of a finished run.
    pub fn of(run: &LaserRun) -> Self {
        let thin: Vec<&Moment> = run.moments.iter().step_by(SMOOTHNESS_STRIDE).collect();
        let second = |m: &[&Moment]| {
            let (a, b, c) = (m[0].pose.position(), m[1].pose.position(), m[2].pose.position());
            (c - b - (b - a)).norm_squared()
        };
        let change = |m: &[&Moment]| (m[1].twist.v - m[0].twist.v).abs() / (m[1].time - m[0].time).max(1e-9);
        let near = run.moments.iter().filter(|m| m.clearance < NEAR_OBSTACLE_M).count();
        Self {
            min_clearance: run.moments.iter().map(|m| m.clearance).fold(f64::INFINITY, f64::min),
            time_near: near as f64 / run.moments.len() as f64,
            time: run.end().time,
            length: run.path_length(),
            path_roughness: mean(thin.windows(3).map(second)),
            speed_roughness: mean(thin.windows(2).map(change)),
            cycle_ms: cycle(&run.cycles_ms),
        }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0_u32), |(sum, n), value| (sum + value, n + 1));
    sum / f64::from(n.max(1))
}

fn cycle(cycles: &[f64]) -> [f64; 4] {
    let mut sorted = cycles.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    let at = |part: f64| sorted.get((last as f64 * part).round() as usize).copied().unwrap_or(0.0);
    [mean(cycles.iter().copied()), at(0.5), at(0.99), at(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_and_quantiles() {
        assert_eq!(cycle(&[1.0, 3.0, 2.0, 10.0]), [4.0, 3.0, 10.0, 10.0]);
        assert_eq!(cycle(&[]), [0.0; 4]);
    }
}
