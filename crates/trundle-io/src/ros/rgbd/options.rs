//! The requested topics of a bag.

/// The requested topics; for `None` the bag's content decides.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RosSequenceOptions {
    /// Topic of colour images.
    pub color_topic: Option<String>,
    /// Topic of depth images, registered to colour.
    pub depth_topic: Option<String>,
    /// Topic of the camera's intrinsics.
    pub info_topic: Option<String>,
    /// Topic of odometry, or of its transforms.
    pub odometry_topic: Option<String>,
    /// Topic of the IMU whose gyro gives the heading.
    pub imu_topic: Option<String>,
    /// Topic of the scans of a laser; only for a robot.
    pub scan_topic: Option<String>,
    /// Whether the bag is for the run of a robot: the scans of a laser are read, and with them images may be missing.
    pub is_for_robot: bool,
}

impl RosSequenceOptions {
    /// Whether a topic of images is requested.
    #[must_use]
    pub fn names_images(&self) -> bool {
        self.color_topic.is_some() || self.depth_topic.is_some()
    }
}
