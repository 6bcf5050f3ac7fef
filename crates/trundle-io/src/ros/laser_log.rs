//! Laser logs of any format: CARMEN logs and ROS bags.

use super::bag_scans::BagScans;
use crate::carmen::{CarmenScans, read_carmen};
use crate::laser_log::{LaserLog, LaserLogOptions, LaserLogScan};
use crate::{Expected, IoError};
use std::path::Path;

/// The scans of a laser log, read one at a time. The file is read twice; the memory does not grow with the number of scans.
#[derive(Debug)]
pub struct LaserLogScans {
    format: Format,
}

#[derive(Debug)]
enum Format {
    Carmen(Box<CarmenScans>),
    Bag(Box<BagScans>),
}

impl LaserLogScans {
    /// Opens a log. Returns the log without its scans, and the reader of the scans. The log's odometry is empty if the log has no times of
    /// beams: then no scan needs poses beside its own.
    ///
    /// # Errors
    /// As [`read_laser_log`].
    pub fn open(path: &Path, options: &LaserLogOptions) -> Result<(LaserLog, Self), IoError> {
        if Expected::LaserLog.check(path)?.is_bag() {
            let (log, scans) = BagScans::open(path, options)?;
            return Ok((log, Self { format: Format::Bag(Box::new(scans)) }));
        }
        let (log, scans) = CarmenScans::open(path, options)?;
        let log = LaserLog { odometry: Vec::new(), ..log };
        Ok((log, Self { format: Format::Carmen(Box::new(scans)) }))
    }

    /// The next scan, by rising stamps; `None` after the last one. Counts the scan, or what is skipped, in `log`, which
    /// [`LaserLogScans::open`] returned.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn next_scan(&mut self, log: &mut LaserLog) -> Result<Option<LaserLogScan>, IoError> {
        match &mut self.format {
            Format::Carmen(scans) => scans.next_scan(log),
            Format::Bag(scans) => Ok(scans.next_scan(log)),
        }
    }

    /// Number of scans that are not read yet; some of them may turn out to be unusable.
    #[must_use]
    pub fn left(&self) -> usize {
        match &self.format {
            Format::Carmen(scans) => scans.left(),
            Format::Bag(scans) => scans.left(),
        }
    }
}

/// The scans and odometry of a CARMEN log, an MCAP file, a ROS 2 bag (its folder or a file of it) or a ROS 1 bag. [`LaserLogScans`] reads
/// the scans of a long log one at a time.
///
/// # Errors
/// As [`read_carmen`] and [`read_ros_bag`].
pub fn read_laser_log(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    match Expected::LaserLog.check(path)? {
        kind if kind.is_bag() => read_ros_bag(path, options),
        _ => read_carmen(path, options),
    }
}

/// The scans of a ROS 2 bag (MCAP or SQLite) or a ROS 1 bag, each with the odometry at its stamp, interpolated. The static transforms
/// give the mount of the laser. Times are those in the messages' headers.
///
/// Messages up to 0.05 s out of order are sorted. One that is broken, whose time goes back farther, or that no odometry is known for is
/// skipped and named in
/// [`LaserLog::skipped`], by its number in the bag.
///
/// # Errors
/// When the bag cannot be read or is truncated before its first scan, there is no scan or no odometry, no transform gives the mount of the
/// laser, or no scan can be used: then the first problem is named.
pub fn read_ros_bag(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    let (mut log, mut scans) = BagScans::open(path, options)?;
    while let Some(scan) = scans.next_scan(&mut log) {
        log.scans.push(scan);
    }
    Ok(log)
}
