//! Names of coordinate frames.

/// Names of coordinate frames, as REP 105 has them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FrameNames {
    /// The map.
    pub map: String,
    /// The odometry.
    pub odom: String,
    /// The base.
    pub base: String,
    /// The camera's optical frame.
    pub camera: String,
    /// The frame of the scan from depth images: the axes of the base, at the camera's position on the floor.
    pub scan: String,
}

impl Default for FrameNames {
    fn default() -> Self {
        Self {
            map: "map".to_owned(),
            odom: "odom".to_owned(),
            base: "base_link".to_owned(),
            camera: "camera_optical_frame".to_owned(),
            scan: "camera_scan".to_owned(),
        }
    }
}
