//! The topics of a bag.

use clap::Args;
use trundle::io::RosSequenceOptions;

/// The topics of a bag.
#[derive(Debug, Clone, Args)]
pub struct BagTopicsArgs {
    /// The topic of a bag's colour images [default: the one with the largest number of images; `trundle convert BAG --list` lists all]
    #[arg(long, value_name = "TOPIC")]
    pub color_topic: Option<String>,
    /// The topic of a bag's depth images, registered to colour [default: the only one in the frame of colour]
    #[arg(long, value_name = "TOPIC")]
    pub depth_topic: Option<String>,
    /// The topic of the camera_info of a bag's colour images [default: the one with the same prefix]
    #[arg(long, value_name = "TOPIC", hide_short_help = true)]
    pub info_topic: Option<String>,
    /// The topic of a bag's odometry, or of its transforms [default: the one with the largest number of messages]
    #[arg(long, value_name = "TOPIC")]
    pub odom_topic: Option<String>,
    /// The topic of a bag's IMU, whose gyro gives the heading [default: the one with the largest number of usable readings]
    #[arg(long, value_name = "TOPIC", hide_short_help = true)]
    pub imu_topic: Option<String>,
    /// The topic of a laser's scans; in a CARMEN log the name of the lines, as RAWLASER2 [default: the one with the largest number of scans]
    #[arg(long, value_name = "TOPIC")]
    pub scan_topic: Option<String>,
}

impl BagTopicsArgs {
    /// The topics.
    pub fn options(&self) -> RosSequenceOptions {
        let images = [&self.color_topic, &self.depth_topic, &self.info_topic];
        RosSequenceOptions::of_topics(images, [&self.odom_topic, &self.imu_topic, &self.scan_topic])
    }
}
