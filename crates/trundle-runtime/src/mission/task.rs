//! A task of a mission.

use serde::{Deserialize, Serialize};
use std::fmt;
use trundle_core::Pose2;

/// A task of a mission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Task {
    /// Drive to a pose in the map frame and stop there.
    Go(Pose2),
    /// Observe each frontier that can be reached, until the map is complete.
    Explore,
    /// Drive back to the pose at power-on and stop there.
    Return,
    /// Drive onto the charging station, until the battery charges.
    Dock,
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Go(pose) => {
                write!(f, "go to ({:.2} m, {:.2} m, {:.0} deg)", pose.x, pose.y, pose.theta.to_degrees())
            }
            Self::Explore => f.write_str("explore"),
            Self::Return => f.write_str("return to the start"),
            Self::Dock => f.write_str("dock at the charging station"),
        }
    }
}
