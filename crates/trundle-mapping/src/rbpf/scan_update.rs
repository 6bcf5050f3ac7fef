//! Result of processing one scan.

use crate::scan_match::global_search::Lost;
use nalgebra::Matrix3;
use trundle_core::{Pose2, Stamp};

/// Result of a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ScanUpdate {
    /// The robot has hardly moved: the scan was not used.
    Still,
    /// Refused: what is wrong with it.
    Refused(Refusal),
    /// The scan moved the particles and is in their maps.
    Processed(Processed),
    /// Where the robot is in the map is not known, after [`crate::ParticleMapper::kidnapped`] or a pause: the map does not change.
    Lost(Lost),
    /// The last scans contradict the map that the run began with. They are taken out of the map again, and the robot is searched for.
    Paused(MappingPause),
    /// It is known from now on.
    Found(Pose2),
}

/// Scans that contradict the map that the run began with: the robot was carried away, or the map is another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MappingPause {
    /// Stamp of the first of them.
    pub since: Stamp,
    /// Number of scans that were processed before and are taken out of the map again.
    pub removed_scans: usize,
}

/// Why a scan was not used.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// Part of them that lies on free ground of it with no obstacle near, 0 to 1.
    pub contradicted: f64,
    /// Directions that the best particle left to the odometry, 0 to 3: 3 is no overlap with the map.
    pub degenerate: usize,
    /// Covariance of the Gaussian that the best particle's pose was drawn from: m, m, rad, map frame.
    pub covariance: Matrix3<f64>,
    /// Effective number of particles before resampling.
    pub effective: f64,
    /// Whether particles were resampled.
    pub resampled: bool,
    /// Whether the odometry jumped farther than `jump`: the pose then stays, or, with a `pose_prior`, follows the odometry.
    pub jumped: bool,
    /// Whether the scan showed that the odometry was wrong: slipping wheels, lost messages.
    pub slipped: bool,
    /// Largest shift of a pose, m, where a loop that was closed some scans before corrected trajectory and map.
    pub loop_correction_m: Option<f64>,
}
