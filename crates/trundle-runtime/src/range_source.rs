//! The sensor that gives the scans.

use serde::{Deserialize, Serialize};

/// Sensor whose scans the map is drawn from and the safety monitor uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RangeSource {
    /// The depth camera, its images cut to a scan.
    #[default]
    DepthCamera,
    /// A 2-D laser's own scans. A camera, if present, still corrects the pose.
    Laser,
}
