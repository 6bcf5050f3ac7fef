//! The sensor of the scans.

use serde::{Deserialize, Serialize};

/// Sensor of the scans for the map and for the safety monitor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RangeSource {
    /// The depth camera: scans are computed from its images.
    #[default]
    DepthCamera,
    /// A 2-D laser's own scans. A camera, if present, still corrects the pose.
    Laser,
}
