//! Pose and motion of a frame by images and odometry.

use trundle_core::{CameraMotion, Pose3, Stamp};

/// A frame of a sequence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SequenceFrame {
    /// Time of the image.
    pub stamp: Stamp,
    /// Pose by the image; `None` if the image did not locate the camera.
    pub visual: Option<MapPose>,
    /// Motion since the previous frame by odometry, with its covariance; `None` if not measured.
    pub motion: Option<CameraMotion>,
}

/// A pose in one of the visual maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPose {
    /// Number of the map; the placed map with the lowest number gives the frame of the fused trajectory.
    pub map: u32,
    /// Pose of the camera in the map's frame, m and rad.
    pub map_from_camera: Pose3,
}
