//! The log of a laser with odometry, as the readers of CARMEN logs and of bags return it.

mod empty_map;
mod motion;
mod options;
mod order;
mod sources;
mod statistics;
mod sweep;

pub use empty_map::{empty_map_cause, no_overlap_cause, no_return_cause, range_unit_hint};
pub(crate) use motion::{Motion, pose_at};
pub use options::LaserLogOptions;
pub(crate) use order::{OrderBuffer, insert_in_order};
pub use sources::LaserLogSources;
pub(crate) use sources::{chosen, is_named};
pub use statistics::LaserLogStatistics;
pub(crate) use sweep::{MAX_BEAMS, check_sweep};

use crate::Warnings;
use trundle_core::{Pose2, Scan, Stamp};

/// A scan with the odometry of its moment.
#[derive(Debug, Clone, PartialEq)]
pub struct LaserLogScan {
    /// The pose by odometry.
    pub odom_from_base: Pose2,
    /// The scan, base frame. Beams without a return or with a bad range are unseen.
    pub scan: Scan,
}

/// The rotation of a laser on the base.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LaserMount {
    /// Rotation to the left, rad.
    pub turn: f64,
    /// Whether the laser is upside down: its beams then run from left to right.
    pub upside_down: bool,
}

/// A line, or a message of a bag, that could not be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LaserLogSkip {
    /// The line, or the message's number in the bag, from 1.
    pub line: usize,
    /// The problem.
    pub problem: String,
}

/// The log of a laser with odometry.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LaserLog {
    /// The scans, by rising stamps; empty if they are read one at a time.
    pub scans: Vec<LaserLogScan>,
    /// Numbers of the scans that were read.
    pub statistics: LaserLogStatistics,
    /// The poses by odometry, by rising stamps.
    pub odometry: Vec<(Stamp, Pose2)>,
    /// Lines or messages that were skipped.
    pub skipped: Vec<LaserLogSkip>,
    /// Number of ranges that were negative, zero or no number; in a CARMEN log also infinite ones, in a bag also those below `range_min`.
    pub bad_ranges: usize,
    /// The first line, or message, with such a range.
    pub first_bad_range: Option<usize>,
    /// Smallest range that counted as no return, m.
    pub max_range: Option<f64>,
    /// The reason why the depth images of the scans have no usable depth; `None` if they have, or if the scans are those of a laser.
    pub depth_problem: Option<String>,
    /// The topics of a bag, or the lines of a CARMEN log, that made the log, and the unused ones.
    pub sources: LaserLogSources,
    /// The assumed mount of the laser.
    pub mount: LaserMount,
}

impl LaserLog {
    /// A log of these scans, by rising stamps.
    #[must_use]
    pub fn of_scans(scans: impl IntoIterator<Item = LaserLogScan>) -> Self {
        let mut log = Self::default();
        scans.into_iter().for_each(|scan| log.push(scan));
        log
    }

    /// Adds a scan that is not older than the last one.
    pub fn push(&mut self, scan: LaserLogScan) {
        self.statistics.count(&scan);
        self.scans.push(scan);
    }

    /// Number of scans without a return in any beam.
    #[must_use]
    pub fn scans_without_return(&self) -> usize {
        self.statistics.scans_without_return
    }

    /// Warnings about skipped messages and bad ranges, one per kind.
    #[must_use]
    pub fn warnings(&self) -> Warnings {
        let mut warnings = Warnings::default();
        for skip in &self.skipped {
            warnings.add(&format!("skipped, {}", skip.problem), &format!("entry {}", skip.line));
        }
        if let Some(first) = self.first_bad_range {
            let problem = format!(
                "{} ranges are negative, zero, infinite, not a number or below the laser's minimum range and taken as unseen, the first in",
                self.bad_ranges
            );
            warnings.add(&problem, &format!("entry {first}"));
        }
        warnings
    }
}
