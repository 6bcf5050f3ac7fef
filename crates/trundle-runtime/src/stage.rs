use serde::Serialize;
use std::time::{Duration, Instant};

/// A stage of the robot, for the table of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Wheels and gyro to odometry.
    Odometry,
    /// RGB-D image to camera pose.
    Slam,
    /// Depth image to scan.
    Scan,
    /// Scan against map.
    ScanMatch,
    /// Fusion to one pose estimate.
    Localization,
    /// Scan into the grid.
    Mapping,
    /// Mission to goal: where to go or to look next.
    Supervision,
    /// Grid to path, curve and trajectory.
    Planning,
    /// Trajectory and pose to twist.
    Control,
    /// Braking distance against scan and map.
    Safety,
}

impl Stage {
    /// Every stage, in the order of the data.
    pub const ALL: [Self; 10] = [
        Self::Odometry,
        Self::Slam,
        Self::Scan,
        Self::ScanMatch,
        Self::Localization,
        Self::Mapping,
        Self::Supervision,
        Self::Planning,
        Self::Control,
        Self::Safety,
    ];

    /// The name in tables and in `summary.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Odometry => "odometry",
            Self::Slam => "slam",
            Self::Scan => "scan",
            Self::ScanMatch => "scan_match",
            Self::Localization => "localization",
            Self::Mapping => "mapping",
            Self::Supervision => "supervision",
            Self::Planning => "planning",
            Self::Control => "control",
            Self::Safety => "safety",
        }
    }
}

/// What the stages cost: wall-clock time, for reports only. No decision of the robot reads it.
#[derive(Debug, Clone, Default)]
pub struct StageTimes {
    samples: [Vec<f32>; Stage::ALL.len()],
}

/// The cost of one stage over a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StageCost {
    /// How often it ran.
    pub runs: usize,
    /// Milliseconds.
    pub median_ms: f64,
    /// Milliseconds.
    pub p99_ms: f64,
}

impl StageTimes {
    /// Runs `work` and notes what it took.
    pub fn measure<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.note(stage, start.elapsed());
        result
    }

    fn note(&mut self, stage: Stage, elapsed: Duration) {
        self.samples[stage as usize].push(elapsed.as_secs_f32() * 1e3);
    }

    /// How often a stage ran so far.
    pub fn runs(&self, stage: Stage) -> usize {
        self.samples[stage as usize].len()
    }

    /// The cost of a stage; `None` when it never ran.
    pub fn cost(&self, stage: Stage) -> Option<StageCost> {
        let mut sorted = self.samples[stage as usize].clone();
        sorted.sort_by(f32::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |fraction: f64| f64::from(sorted[(last as f64 * fraction).round() as usize]);
        Some(StageCost { runs: sorted.len(), median_ms: at(0.5), p99_ms: at(0.99) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_of_the_sorted_samples() {
        let mut times = StageTimes::default();
        for ms in (1..=101).rev() {
            times.note(Stage::Slam, Duration::from_millis(ms));
        }
        let cost = times.cost(Stage::Slam).unwrap();
        assert_eq!((cost.runs, cost.median_ms.round(), cost.p99_ms.round()), (101, 51.0, 100.0));
        assert_eq!(times.cost(Stage::Scan), None);
    }

    #[test]
    fn every_stage_has_its_own_place() {
        for (i, stage) in Stage::ALL.into_iter().enumerate() {
            assert_eq!(stage as usize, i, "{}", stage.name());
        }
    }
}
