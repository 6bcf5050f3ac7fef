//! The command line of `trundle ros2`.

use crate::common_args::{NumberArg, NumberText, PoseArg};
use crate::live::LiveArgs;
use crate::output_args::{ContinuedFileArg, OutputDirArg};
use crate::ros_node::RosArgs;
use crate::run::RunOptions;
use clap::Args;
use std::path::PathBuf;
use trundle::app::MissionRequest;
use trundle::ros2::Ros2Options;
use trundle::ros2::body::BodySettings;

/// `trundle ros2`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle ros2 --ros-args -r odom:=wheel/odom -p use_sim_time:=true\n\n\
    Without a mission it waits for goals: NavigateToPose, goal_pose of RViz (docs/how-to/ros2.md).")]
pub struct Ros2Args {
    /// The robot's topics.
    #[command(flatten)]
    pub topics: TopicArgs,
    /// Network and names.
    #[command(flatten)]
    pub ros: RosArgs,
    /// Goal in the map frame: m, m, deg; may be repeated.
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true, conflicts_with_all = ["explore", "mission"])]
    pub goal: Vec<PoseArg>,
    /// Explore until the map is complete, then return.
    #[arg(long, conflicts_with = "mission")]
    pub explore: bool,
    /// The tasks of a mission file.
    #[arg(long, value_name = "FILE")]
    pub mission: Option<PathBuf>,
    /// Resume the mission and the maps of a checkpoint, then wait for goals.
    #[arg(long, value_name = "CHECKPOINT", conflicts_with_all = ["goal", "explore", "mission"])]
    pub resume: Option<ContinuedFileArg>,
    /// Continue after the mission and wait for goals.
    #[arg(long)]
    pub stay: bool,
    /// Longest wait for the robot's topics, s
    #[arg(long, value_name = "S", default_value_t = 30.0, value_parser = NumberArg(NumberText::above_zero("s")))]
    pub wait: f64,
    /// Files, time and settings.
    #[command(flatten)]
    pub options: RunOptions,
    /// The live page.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/ros2")]
    pub out: OutputDirArg,
}

/// The topics of the robot.
#[derive(Debug, Args)]
pub struct TopicArgs {
    /// Colour images: `.../compressed`, or raw images.
    #[arg(long, value_name = "TOPIC", default_value = "camera/color/image_raw/compressed")]
    pub color: String,
    /// Depth images: `.../compressedDepth`, or raw images of 16UC1 or 32FC1.
    #[arg(long, value_name = "TOPIC", default_value = "camera/depth/image_raw/compressedDepth")]
    pub depth: String,
    /// Intrinsics of the colour camera.
    #[arg(long, value_name = "TOPIC", default_value = "camera/color/camera_info")]
    pub camera_info: String,
    /// Intrinsics of a depth camera whose images are not registered to colour.
    #[arg(long, value_name = "TOPIC")]
    pub depth_info: Option<String>,
    /// Gyro; if it has messages, it gives the heading in place of the odometry. `none`: not used.
    #[arg(long, value_name = "TOPIC", default_value = "imu")]
    pub imu: String,
    /// A 2-D laser, instead of scans from depth images.
    #[arg(long, value_name = "TOPIC")]
    pub scan: Option<String>,
    /// Battery: at a charge of 2 % or less the robot stops. Not for drivers that report 0 for an unknown charge.
    #[arg(long, value_name = "TOPIC", hide_short_help = true)]
    pub battery: Option<String>,
}

impl TopicArgs {
    /// The topics, and what the options of ROS 2 say about them.
    pub fn settings(&self, options: &Ros2Options) -> BodySettings {
        let mut settings = BodySettings::of(options);
        (settings.color, settings.depth) = (self.color.clone(), self.depth.clone());
        settings.camera_info = self.camera_info.clone();
        settings.depth_info = self.depth_info.clone();
        settings.imu = (self.imu != "none").then(|| self.imu.clone());
        (settings.scan, settings.battery) = (self.scan.clone(), self.battery.clone());
        settings
    }
}

impl Ros2Args {
    /// Whether the run continues after its mission.
    pub fn stays(&self) -> bool {
        self.stay || self.live.is_operated() || self.request().is_empty()
    }

    /// The requested mission.
    pub fn request(&self) -> MissionRequest {
        let goals = self.goal.iter().map(|goal| goal.0).collect();
        MissionRequest { goals, explore: self.explore, dock: false, file: self.mission.clone() }
    }
}
