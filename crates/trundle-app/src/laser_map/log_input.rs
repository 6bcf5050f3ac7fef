//! A log with what is known of the camera that made its scans.

use trundle_io::LaserLog;
use trundle_mapping::DepthScanConfig;

/// A log, and what is known of the camera where its scans were made of depth images.
#[derive(Debug, Clone)]
pub struct LogInput {
    /// The scans with odometry.
    pub log: LaserLog,
    /// Of depth images; `None` for scans of a laser.
    pub depth: Option<DepthLog>,
    /// Where the recording was cut, in a sentence; `None` for a whole one and for another file.
    pub cut_report: Option<String>,
}

/// How scans were made of depth images.
#[derive(Debug, Clone)]
pub struct DepthLog {
    /// The settings of the scans.
    pub scan: DepthScanConfig,
    /// Distance up to which the camera does not see the floor \[m\].
    pub blind_range: f64,
    /// Whether the motion is that of wheels; else of a tracked camera.
    pub by_wheels: bool,
}
