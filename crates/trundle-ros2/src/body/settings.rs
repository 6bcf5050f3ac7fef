//! Topics and frames of a ROS 2 robot.

use crate::Ros2Options;
use crate::convert::camera_info::Rectification;

/// Topics, frames and forms of a ROS 2 robot's sensors and base.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BodySettings {
    /// Odometry, `nav_msgs/Odometry`.
    pub odom: String,
    /// Gyro, `sensor_msgs/Imu`. If messages arrive, they give the heading; otherwise the heading of the odometry is used.
    pub imu: Option<String>,
    /// Laser, `sensor_msgs/LaserScan`.
    pub scan: Option<String>,
    /// Battery, `sensor_msgs/BatteryState`. An empty one holds the robot, so that a driver that reports 0 for an unknown charge does, too.
    pub battery: Option<String>,
    /// Colour images; the form is by the name: `.../compressed` or raw.
    pub color: String,
    /// Depth images; the form is by the name: `.../compressedDepth` or raw.
    pub depth: String,
    /// Intrinsics of the colour camera.
    pub camera_info: String,
    /// Intrinsics of the depth camera, if depth is not registered to colour.
    pub depth_info: Option<String>,
    /// Commands for the base.
    pub cmd_vel: String,
    /// Whether commands are `TwistStamped`, else `Twist`.
    pub stamped_commands: bool,
    /// The base's frame.
    pub base_frame: String,
    /// Whether `/clock` gives the time.
    pub use_sim_time: bool,
}

impl Default for BodySettings {
    fn default() -> Self {
        Self {
            odom: "odom".to_owned(),
            imu: Some("imu".to_owned()),
            scan: None,
            battery: None,
            color: "camera/color/image_raw/compressed".to_owned(),
            depth: "camera/depth/image_raw/compressedDepth".to_owned(),
            camera_info: "camera/color/camera_info".to_owned(),
            depth_info: None,
            cmd_vel: "cmd_vel".to_owned(),
            stamped_commands: true,
            base_frame: "base_link".to_owned(),
            use_sim_time: false,
        }
    }
}

impl BodySettings {
    /// The default topics, with the base's frame, the clock and the form of commands of these options.
    #[must_use]
    pub fn of(options: &Ros2Options) -> Self {
        Self {
            stamped_commands: options.stamped_commands,
            base_frame: options.frames.base.clone(),
            use_sim_time: options.use_sim_time,
            ..Self::default()
        }
    }

    /// Whether colour comes as JPEG files.
    #[must_use]
    pub fn is_color_compressed(&self) -> bool {
        self.color.ends_with("/compressed")
    }

    /// Whether depth comes as PNG files.
    #[must_use]
    pub fn is_depth_compressed(&self) -> bool {
        self.depth.ends_with("/compressedDepth") || self.depth.ends_with("/compressed")
    }

    /// Whether the images are rectified.
    #[must_use]
    pub fn rectification(&self) -> Rectification {
        Rectification::of_topic(&self.color)
    }
}
