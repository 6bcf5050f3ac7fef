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
    /// The options with the topics of colour, depth and intrinsics, and those of odometry, IMU and laser.
    #[must_use]
    pub fn of_topics(images: [&Option<String>; 3], base: [&Option<String>; 3]) -> Self {
        let [color_topic, depth_topic, info_topic] = images.map(Clone::clone);
        let [odometry_topic, imu_topic, scan_topic] = base.map(Clone::clone);
        let is_for_robot = false;
        Self { color_topic, depth_topic, info_topic, odometry_topic, imu_topic, scan_topic, is_for_robot }
    }

    /// Whether a topic of images is requested.
    #[must_use]
    pub fn names_images(&self) -> bool {
        self.color_topic.is_some() || self.depth_topic.is_some()
    }
}
