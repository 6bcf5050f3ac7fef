//! The stages of a step and their wall-clock times.

use crate::histogram::Histogram;
use serde::Serialize;
use std::time::{Duration, Instant};

/// A stage of the robot, for the table of times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Stage {
    /// Wheels and gyro to odometry.
    Odometry,
    /// Decoding of an image, in a perception job.
    Decoding,
    /// RGB-D image to camera pose.
    Slam,
    /// Depth image to scan.
    Scan,
    /// Visual maps to bytes, for a checkpoint.
    Checkpoint,
    /// Scan against map.
    ScanMatch,
    /// Global localization: scans against the whole map, while the pose is unknown.
    Search,
    /// Fusion to one pose estimate.
    Localization,
    /// Scan into the grid.
    Mapping,
    /// Tracking of dynamic obstacles.
    DynamicObstacles,
    /// Mission to goal: the choice of the next goal or viewpoint.
    Supervision,
    /// Grid to path, curve and trajectory.
    Planning,
    /// The state machine: checks, transitions and the state's own command, without the stages that it runs.
    Behaviour,
    /// Trajectory and pose to twist.
    Control,
    /// Braking distance against scan and map.
    Safety,
}

impl Stage {
    /// Every stage, in the order of the data.
    pub const ALL: [Self; 15] = [
        Self::Odometry,
        Self::Decoding,
        Self::Slam,
        Self::Scan,
        Self::Checkpoint,
        Self::ScanMatch,
        Self::Search,
        Self::Localization,
        Self::Mapping,
        Self::DynamicObstacles,
        Self::Supervision,
        Self::Planning,
        Self::Behaviour,
        Self::Control,
        Self::Safety,
    ];

    /// The name in tables and in `summary.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Odometry => "odometry",
            Self::Decoding => "decoding",
            Self::Slam => "slam",
            Self::Scan => "scan",
            Self::Checkpoint => "saving",
            Self::ScanMatch => "scan_match",
            Self::Search => "search",
            Self::Localization => "localization",
            Self::Mapping => "mapping",
            Self::DynamicObstacles => "dynamic_obstacles",
            Self::Supervision => "supervision",
            Self::Planning => "planning",
            Self::Behaviour => "behaviour",
            Self::Control => "control",
            Self::Safety => "safety",
        }
    }
}

/// Cost of the stages: wall-clock time, for reports only. No decision of the robot uses these times.
#[derive(Debug, Clone, Default)]
pub struct StageTimes {
    /// Milliseconds.
    spent: [Histogram; Stage::ALL.len()],
}

/// The cost of one stage over a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StageCost {
    /// Number of runs of the stage.
    pub runs: u64,
    /// Milliseconds.
    pub median_ms: f64,
    /// Milliseconds.
    pub p99_ms: f64,
    /// Milliseconds.
    pub p999_ms: f64,
    /// Milliseconds.
    pub max_ms: f64,
    /// Total time, s.
    pub total_s: f64,
}

impl StageTimes {
    /// Runs `work` and records its time.
    pub fn measure<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.note(stage, start.elapsed());
        result
    }

    /// Runs `work`, which may measure other stages, and records its time without theirs.
    pub fn measure_rest<T>(&mut self, stage: Stage, work: impl FnOnce(&mut Self) -> T) -> T {
        let (start, before) = (Instant::now(), self.sum_ms());
        let result = work(self);
        let others = Duration::from_secs_f64((self.sum_ms() - before).max(0.0) * 1e-3);
        self.note(stage, start.elapsed().saturating_sub(others));
        result
    }

    /// Time of all stages so far, ms.
    fn sum_ms(&self) -> f64 {
        self.spent.iter().map(Histogram::sum).sum()
    }

    /// Adds the times of another measurement.
    pub fn add(&mut self, other: &Self) {
        self.spent.iter_mut().zip(&other.spent).for_each(|(mine, theirs)| mine.add(theirs));
    }

    fn note(&mut self, stage: Stage, elapsed: Duration) {
        self.spent[stage as usize].note(elapsed.as_secs_f64() * 1e3);
    }

    /// Number of runs of a stage so far.
    pub fn runs(&self, stage: Stage) -> u64 {
        self.spent[stage as usize].count()
    }

    /// The time of all runs of a stage so far, s.
    pub fn total(&self, stage: Stage) -> f64 {
        self.spent[stage as usize].sum() * 1e-3
    }

    /// The cost of a stage; `None` if it never ran.
    pub fn cost(&self, stage: Stage) -> Option<StageCost> {
        let spent = &self.spent[stage as usize];
        Some(StageCost {
            runs: spent.count(),
            median_ms: spent.quantile(0.5)?,
            p99_ms: spent.quantile(0.99)?,
            p999_ms: spent.quantile(0.999)?,
            max_ms: spent.max()?,
            total_s: spent.sum() * 1e-3,
        })
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
        assert!((cost.median_ms / 51.0 - 1.0).abs() < 0.01 && (cost.p99_ms / 100.0 - 1.0).abs() < 0.01);
        assert_eq!((cost.runs, cost.max_ms.round(), cost.total_s), (101, 101.0, 5.151));
        assert_eq!(times.cost(Stage::Scan), None);
    }

    #[test]
    fn the_rest_is_without_the_stages_that_are_measured_in_it() {
        let mut times = StageTimes::default();
        let pause = Duration::from_millis(200);
        times.measure_rest(Stage::Behaviour, |times| {
            times.measure(Stage::Control, || std::thread::sleep(pause));
        });
        assert_eq!((times.runs(Stage::Behaviour), times.runs(Stage::Control)), (1, 1));
        assert!(times.total(Stage::Control) >= 0.2 && times.total(Stage::Behaviour) < 0.1);
    }

    #[test]
    fn every_stage_has_its_own_place() {
        for (i, stage) in Stage::ALL.into_iter().enumerate() {
            assert_eq!(stage as usize, i, "{}", stage.name());
        }
    }

    #[test]
    fn times_of_workers_are_added_to_those_of_the_control_thread() {
        let (mut all, mut worker) = (StageTimes::default(), StageTimes::default());
        assert_eq!(all.measure(Stage::Control, || 7), 7);
        worker.note(Stage::Slam, Duration::from_millis(20));
        worker.note(Stage::Slam, Duration::from_millis(30));
        all.add(&worker);
        assert_eq!((all.runs(Stage::Control), all.runs(Stage::Slam), all.runs(Stage::Safety)), (1, 2, 0));
        let cost = all.cost(Stage::Slam).unwrap();
        assert!((cost.total_s - 0.05).abs() < 1e-9 && (cost.max_ms - 30.0).abs() < 1e-9);
    }

    #[test]
    fn names_differ() {
        let names: std::collections::BTreeSet<_> = Stage::ALL.iter().map(|stage| stage.name()).collect();
        assert_eq!(names.len(), Stage::ALL.len());
    }
}
