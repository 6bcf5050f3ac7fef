//! The settings of reading a laser log: the laser's mount, its maximum range, the topics.

use trundle_core::{Invalid, require_finite, require_in, require_positive};

/// Data that a log lacks, and the topics that are read.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct LaserLogOptions {
    /// Distance of the laser ahead of the base, m. Default: the log's, from the poses of a CARMEN log's lines, else its
    /// `PARAM robot_frontlaser_offset`, else 0; from the transforms of a bag.
    pub laser_x: Option<f64>,
    /// Turn of the laser to the left, rad. Default: the log's, else 0.
    pub laser_turn: Option<f64>,
    /// The laser is upside down: its beams run from left to right.
    pub upside_down: bool,
    /// Smallest range that counts as no return, m. Default: the line's limit, else the range at which many beams end.
    pub max_range: Option<f64>,
    /// The topic of the scans, in a CARMEN log the name of the lines; by default that with the most scans.
    pub scan_topic: Option<String>,
    /// The topic of the odometry of a bag; by default that with the most `Odometry`, else the transforms below `odom`.
    pub odometry_topic: Option<String>,
}

impl LaserLogOptions {
    /// Refuses values that no laser has.
    pub(crate) fn validate(&self) -> Result<(), Invalid> {
        self.laser_x.map_or(Ok(0.0), |x| require_in("laser_x", x, "m", -20.0, 20.0))?;
        self.laser_turn.map_or(Ok(0.0), |turn| require_finite("laser_turn", turn, "rad"))?;
        self.max_range.map_or(Ok(()), |range| require_positive("max_range", range, "m").map(drop))
    }
}
