//! A laser log, with the camera's data if the scans were made from depth images.

use trundle_io::LaserLog;
use trundle_mapping::DepthScanConfig;

/// A log, and the data of the camera if the scans were made from depth images.
#[derive(Debug, Clone)]
pub struct LogInput {
    /// The scans with odometry.
    pub log: LaserLog,
    /// Data of the depth camera; `None` for scans of a laser.
    pub depth: Option<DepthLog>,
    /// Place at which the recording is cut, in a sentence; `None` for a complete recording and for another file.
    pub cut_report: Option<String>,
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
