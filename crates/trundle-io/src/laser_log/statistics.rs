//! Numbers of the scans of a log, which do not grow with the log.

use super::LaserLogScan;
use crate::EvenSample;
use trundle_core::{Beam, Pose2, Stamp};

/// Size at which a sample of values is thinned. Source: ours; the median of a quarter of these values is that of all within a hundredth.
const MAX_SAMPLE_SIZE: usize = 1 << 16;

/// Numbers of the scans of a log. Medians are those of an even sample of the values.
#[derive(Debug, Clone, PartialEq)]
pub struct LaserLogStatistics {
    /// Number of scans.
    pub scans: usize,
    /// Number of scans without a return in any beam.
    pub scans_without_return: usize,
    /// Stamp of the first scan.
    pub first_stamp: Option<Stamp>,
    /// Stamp of the last scan.
    pub last_stamp: Option<Stamp>,
    last_pose: Option<Pose2>,
    /// Ranges of beams with a return \[m\].
    ranges: EvenSample<f64>,
    /// Distances by odometry between neighbouring scans \[m\].
    steps: EvenSample<f64>,
}

impl Default for LaserLogStatistics {
    fn default() -> Self {
        Self {
            scans: 0,
            scans_without_return: 0,
            first_stamp: None,
            last_stamp: None,
            last_pose: None,
            ranges: EvenSample::new(MAX_SAMPLE_SIZE),
            steps: EvenSample::new(MAX_SAMPLE_SIZE),
        }
    }
}

impl LaserLogStatistics {
    /// Counts the next scan, which is not older than the last one.
    pub fn count(&mut self, entry: &LaserLogScan) {
        let LaserLogScan { odom_from_base, scan } = entry;
        let mut is_blind = true;
        for beam in scan.beams() {
            if let Beam::Hit { range } = beam {
                is_blind = false;
                self.ranges.push(*range);
            }
        }
        self.scans += 1;
        self.scans_without_return += usize::from(is_blind);
        self.first_stamp.get_or_insert(scan.stamp());
        self.last_stamp = Some(scan.stamp());
        if let Some(last) = self.last_pose.replace(*odom_from_base) {
            self.steps.push(last.distance(odom_from_base));
        }
    }

    /// Whether no scan has a return. True for a log without scans.
    #[must_use]
    pub fn is_blind(&self) -> bool {
        self.scans_without_return == self.scans
    }

    /// The timestamp that all of two or more scans have.
    #[must_use]
    pub fn only_stamp(&self) -> Option<Stamp> {
        self.first_stamp.filter(|first| self.scans > 1 && self.last_stamp == Some(*first))
    }

    /// Median of the ranges of beams with a return \[m\]; `None` without a return.
    pub(super) fn median_range(&self) -> Option<f64> {
        median(&self.ranges)
    }

    /// Median distance by odometry between two scans \[m\]; `None` with less than two scans.
    pub(super) fn median_step(&self) -> Option<f64> {
        median(&self.steps)
    }
}

/// The upper median; `None` without values.
fn median(sample: &EvenSample<f64>) -> Option<f64> {
    let mut values = sample.elements().to_vec();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
