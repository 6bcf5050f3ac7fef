//! Result of processing one scan.

use crate::scan_match::global_search::Lost;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Stamp};

/// Result of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScanUpdate {
    /// The robot has hardly moved: the scan was not used.
    Still,
    /// The scan was refused.
    Refused(Refusal),
    /// The scan moved the particles and is in their maps.
    Processed(Processed),
    /// The robot's pose in the map is unknown, after [`crate::ParticleMapper::kidnapped`] or a pause: the map does not change.
    Lost(Lost),
    /// The last scans contradict the loaded map. They are removed from the map, and a search for the robot begins.
    Paused(MappingPause),
    /// The search found this pose.
    Found(Pose2),
}

/// Scans that contradict the loaded map: the robot was carried away, or the map is of another place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MappingPause {
    /// Stamp of the first contradicting scan.
    pub since: Stamp,
    /// Number of processed scans that are removed from the map.
    pub removed_scans: usize,
}

/// Reason why a scan was not used.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// The odometry is not finite.
    NotFinite,
    /// The scan is older than the last one.
    TimeGoesBack,
    /// The odometry's pose is more than 1000 km from its origin; or, for odometry without drift (`pose_prior`), farther from the last one
    /// than `jump` a second allows. Five such poses in a row that agree with each other are accepted.
    OutOfReach,
}

/// A processed scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Processed {
    /// Part of the hits that the best particle's map explains, 0 to 1.
    pub explained: f64,
    /// Fraction of the hits on free ground of that map without a near obstacle, 0 to 1.
    pub contradicted: f64,
    /// Number of directions that the odometry alone determined, 0 to 3: 3 means no overlap with the map.
    pub degenerate: usize,
    /// Covariance of the Gaussian of the best particle's pose: m, m, rad, map frame.
    pub covariance: Matrix3<f64>,
    /// Effective number of particles before resampling.
    pub effective: f64,
    /// Whether particles were resampled.
    pub resampled: bool,
    /// Whether the odometry jumped farther than `jump`: the pose then stays, or, with a `pose_prior`, follows the odometry.
    pub jumped: bool,
    /// Whether the scan showed that the odometry was wrong: slipping wheels, lost messages.
    pub slipped: bool,
    /// Largest displacement of a pose, m, if this scan completed the correction by a loop.
    pub loop_correction_m: Option<f64>,
}
