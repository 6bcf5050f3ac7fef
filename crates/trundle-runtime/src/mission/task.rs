//! A task of a mission.

use super::goal_options::TaskGoal;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;
use trundle_core::{Invalid, MAX_COORDINATE_M, Pose2, require_finite, require_in};

/// A task of a mission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Task {
    /// Drive to a goal in the map frame and stop there.
    Go(TaskGoal),
    /// Observe each reachable frontier, until the map is complete.
    Explore,
    /// Drive back to the pose at power-on and stop there.
    Return,
    /// Turn on the spot by an angle, positive to the left \[rad\].
    Turn {
        /// \[rad\]
        angle: f64,
    },
    /// Drive straight by a distance, positive ahead.
    Straight {
        /// \[m\]
        distance: f64,
        /// \[m/s\]
        speed: f64,
    },
    /// Drive onto the charging station, until the battery charges.
    Dock,
}

/// Largest angle of a turn \[rad\]: ten revolutions. Source: ours.
const MAX_TURN_RAD: f64 = 20.0 * PI;
/// Largest distance of a straight drive \[m\]. Source: ours.
const MAX_STRAIGHT_M: f64 = 100.0;
/// Range of the speed of a straight drive \[m/s\]. The base's limits apply as well. Source: ours.
const STRAIGHT_SPEED_RANGE_M_S: (f64, f64) = (0.01, 2.0);

impl Task {
    /// The task to drive to a pose, map frame, and to settle exactly on it.
    #[must_use]
    pub fn go(pose: Pose2) -> Self {
        Self::Go(pose.into())
    }

    /// Checks the numbers of the task at `index` of a mission, from 0; messages count from 1.
    pub(super) fn require_usable(&self, index: usize) -> Result<(), Invalid> {
        let number = index + 1;
        match *self {
            Self::Go(TaskGoal { pose, options }) => {
                let (max, of) = (MAX_COORDINATE_M, format!("of the goal of task {number}"));
                options.validated(&of)?;
                require_in(&format!("x {of}"), pose.x, "m", -max, max)?;
                require_in(&format!("y {of}"), pose.y, "m", -max, max)?;
                require_finite(&format!("heading {of}"), pose.theta, "rad").map(drop)
            }
            Self::Turn { angle } => {
                require_in(&format!("angle of task {number}"), angle, "rad", -MAX_TURN_RAD, MAX_TURN_RAD)
                    .map(drop)
            }
            Self::Straight { distance, speed } => {
                let (min, max) = STRAIGHT_SPEED_RANGE_M_S;
                require_in(
                    &format!("distance of task {number}"),
                    distance,
                    "m",
                    -MAX_STRAIGHT_M,
                    MAX_STRAIGHT_M,
                )?;
                require_in(&format!("speed of task {number}"), speed, "m/s", min, max).map(drop)
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Task {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Go(TaskGoal { pose, .. }) => {
                write!(f, "go to ({:.2} m, {:.2} m, {:.0} deg)", pose.x, pose.y, pose.theta.to_degrees())
            }
            Self::Turn { angle } => write!(f, "turn by {:.0} deg", angle.to_degrees()),
            Self::Straight { distance, .. } if *distance < 0.0 => write!(f, "drive {:.2} m back", -distance),
            Self::Straight { distance, .. } => write!(f, "drive {distance:.2} m ahead"),
            Self::Explore => f.write_str("explore"),
            Self::Return => f.write_str("return to the start"),
            Self::Dock => f.write_str("dock at the charging station"),
        }
    }
}
