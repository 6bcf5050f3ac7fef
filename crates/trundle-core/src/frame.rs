//! Names of the coordinate frames.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A coordinate frame. "Frame" alone means an image; this is the other kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum FrameId {
    /// THE map frame: the occupancy grid's. x and y in the floor plane, z up.
    Map,
    /// Start pose by wheels and gyro: continuous, drifting.
    Odom,
    /// The robot's base: between the driven wheels on the floor, x forward, y left, z up (REP 105 `base_link`).
    Base,
    /// The camera's optical frame: x right, y down, z forward.
    Camera,
    /// The frame of the visual landmark map.
    Visual,
    /// The simulator's or the motion-capture system's world.
    World,
}

impl fmt::Display for FrameId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Map => "map",
            Self::Odom => "odom",
            Self::Base => "base_link",
            Self::Camera => "camera",
            Self::Visual => "visual",
            Self::World => "world",
        })
    }
}
