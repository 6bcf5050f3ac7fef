//! A laser log and its scans, with the camera's data if the scans were made from depth images.

use super::neighbours::neighbours;
use crate::AppError;
use std::vec::IntoIter;
use trundle_core::{Pose2, Stamp, deskewed};
use trundle_io::{LaserLog, LaserLogScan, LaserLogScans};
use trundle_mapping::DepthScanConfig;

/// A log, its scans, and the data of the camera if the scans were made from depth images.
#[derive(Debug)]
pub struct LogInput {
    /// The log. Its scans are empty if they are read one at a time, and once [`LogInput::next_scan`] has begun.
    pub log: LaserLog,
    /// The source of the scans.
    pub(super) scans: LogScans,
    /// Data of the depth camera; `None` for scans of a laser.
    pub depth: Option<DepthLog>,
    /// Place at which the recording is cut, in a sentence; `None` for a complete recording and for another file.
    pub cut_report: Option<String>,
    /// Whether each beam is corrected for the motion of the base during the scan.
    pub(super) is_deskewed: bool,
}

/// The source of the scans of a log.
#[derive(Debug)]
pub(super) enum LogScans {
    /// Those of the log in memory.
    InLog,
    /// The rest of those that were in the log.
    Taken(IntoIter<LaserLogScan>),
    /// A file that is read one scan at a time.
    File(LaserLogScans),
}

impl LogInput {
    /// A log with its scans in memory.
    pub(super) fn in_memory(log: LaserLog, depth: Option<DepthLog>, cut_report: Option<String>) -> Self {
        Self { log, scans: LogScans::InLog, depth, cut_report, is_deskewed: false }
    }

    /// The next scan; `None` after the last one.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn next_scan(&mut self) -> Result<Option<LaserLogScan>, AppError> {
        if let LogScans::InLog = self.scans {
            self.scans = LogScans::Taken(std::mem::take(&mut self.log.scans).into_iter());
        }
        let next = match &mut self.scans {
            LogScans::File(file) => file.next_scan(&mut self.log)?,
            LogScans::Taken(scans) => scans.next(),
            LogScans::InLog => None,
        };
        let odometry = &self.log.odometry;
        Ok(next.map(|entry| if self.is_deskewed { deskew(entry, odometry) } else { entry }))
    }

    /// Number of scans of the log, read or not.
    #[must_use]
    pub fn scan_count(&self) -> usize {
        let left = if let LogScans::File(file) = &self.scans { file.left() } else { 0 };
        self.log.statistics.scans + left
    }
}

/// The scan as if all its beams were measured at its stamp.
fn deskew(entry: LaserLogScan, odometry: &[(Stamp, Pose2)]) -> LaserLogScan {
    let pose = |stamp| neighbours(odometry, stamp).map(|(a, b, part)| a.interpolate(&b, part));
    LaserLogScan { scan: deskewed(entry.scan, pose), ..entry }
}

/// Settings by which scans were made from depth images.
#[derive(Debug, Clone)]
pub struct DepthLog {
    /// The settings of the scans.
    pub scan: DepthScanConfig,
    /// Distance up to which the camera does not see the floor \[m\].
    pub blind_range: f64,
    /// Whether the motion comes from wheels; otherwise it comes from visual tracking.
    pub by_wheels: bool,
}
