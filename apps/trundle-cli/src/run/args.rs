//! The command line of `trundle run`.

use crate::common_args::{Common, NumberArg, NumberText, PoseArg, RobotArgs, choice};
use crate::live::LiveArgs;
use crate::output_args::{ContinuedFileArg, EditedFileArg, OutputDirArg, OutputFileArg};
use clap::Args;
use std::path::PathBuf;
use trundle::app::hardware::{GyroOrigin, IntrinsicsSource};
use trundle::app::{AppError, MissionRequest, RecordingContent, RunSetup};
use trundle::drivers::{BaseSpec, CameraSpec};
use trundle::runtime::{Mission, RobotConfig};

/// `trundle run`
#[derive(Debug, Args)]
#[cfg_attr(feature = "ros2", command(mut_arg("ros2", |ros2| ros2.group("MissionArgs"))))]
#[command(after_help = "Example: trundle run --base kobuki --camera stream:/tmp/camera --goal 3,1,90\n\n\
    Ctrl-C stops the robot and ends the run. `trundle devices` lists what is plugged in.\n\
    Exit code: 0 mission done and nothing touched, 1 otherwise, 2 bad input or a device that does not answer.")]
pub struct RunArgs {
    /// The base: kobuki, or kobuki:PORT.
    #[arg(long, value_name = "BASE", default_value = "kobuki")]
    pub base: BaseSpec,
    /// The depth camera: realsense, freenect (Kinect v1), orbbec, openni2, stream:PATH, folder:PATH (docs/camera-stream.md), kinect2-dump:FILE; a serial number or recording may follow, as realsense:FILE.db3.
    #[arg(long, value_name = "CAMERA")]
    pub camera: CameraSpec,
    /// Intrinsics of the colour camera: those reported by the camera, or those of the robot file.
    #[arg(long, value_name = "FROM", default_value = "device", value_parser = choice(&IntrinsicsSource::CHOICES))]
    pub intrinsics: IntrinsicsSource,
    /// The gyro: the base's, or that of a RealSense camera.
    #[arg(long, value_name = "FROM", default_value = "base", value_parser = choice(&GyroOrigin::CHOICES))]
    pub gyro: GyroOrigin,
    /// The mission.
    #[command(flatten)]
    pub mission: MissionArgs,
    /// Write the measurements of --check into this robot file; its other keys do not change.
    #[arg(long, value_name = "ROBOT.toml", requires = "check", conflicts_with_all = ["goal", "explore", "dock", "mission", "resume"])]
    pub write: Option<EditedFileArg>,
    /// Files, time and settings.
    #[command(flatten)]
    pub options: RunOptions,
    /// The live page.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/run")]
    pub out: OutputDirArg,
    /// The robot on ROS 2.
    #[cfg(feature = "ros2")]
    #[command(flatten)]
    pub ros_robot: crate::ros_node::RosRobotArgs,
}

impl RunArgs {
    /// Whether a person or a program may give commands to the run.
    pub fn is_operated(&self) -> bool {
        #[cfg(feature = "ros2")]
        if self.ros_robot.ros2 {
            return true;
        }
        self.live.is_operated()
    }
}

/// Options of every run on a live robot.
#[derive(Debug, Args)]
pub struct RunOptions {
    /// Write the robot's maps and the state of its mission to FILE, every 3 to 10 s: `--resume FILE` continues from it.
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<OutputFileArg>,
    /// Content of recording.mcap; a replay needs all. Below 1 GB of free disk the run continues without recording.
    #[arg(long, value_name = "WHAT", default_value = "events", value_parser = choice(&RecordingContent::CHOICES))]
    pub record: RecordingContent,
    /// Recognise places by this vocabulary, in trundle's form [default: the built-in one]
    #[arg(long, value_name = "FILE")]
    pub vocabulary: Option<PathBuf>,
    /// End the run after this time, s [default: none]
    #[arg(long, value_name = "S", value_parser = NumberArg(NumberText::above_zero("s")), allow_negative_numbers = true)]
    pub time_limit: Option<f64>,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

impl RunOptions {
    /// The setup of a run of `command` in real time.
    pub fn setup(
        &self,
        command: &str,
        name: &str,
        mission: Mission,
        robot: RobotConfig,
    ) -> Result<RunSetup, AppError> {
        let mut setup = RunSetup::new(name, mission, robot).by_command(command);
        setup.time_limit = self.time_limit.unwrap_or(f64::MAX);
        setup.real_time = true;
        setup.recording = self.record;
        setup.with_vocabulary_of(self.vocabulary.as_deref())
    }
}

/// The mission of a run: one of these, optionally with the charging station at its end.
#[derive(Debug, Args)]
#[group(required = true, multiple = true)]
pub struct MissionArgs {
    /// Goal in the map frame, which starts at the robot: m, m, deg; may be repeated for further goals.
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true, conflicts_with_all = ["explore", "mission", "resume"])]
    pub goal: Vec<PoseArg>,
    /// Explore until the map is complete, then return to the start.
    #[arg(long, conflicts_with_all = ["mission", "resume"])]
    pub explore: bool,
    /// Drive onto the charging station, alone or after the goals, and stop when the battery charges.
    #[arg(long, conflicts_with_all = ["mission", "resume"])]
    pub dock: bool,
    /// The tasks of a mission file (docs/formats.md).
    #[arg(long, value_name = "FILE", conflicts_with = "resume")]
    pub mission: Option<PathBuf>,
    /// Resume the mission and the maps of a checkpoint.
    #[arg(long, value_name = "CHECKPOINT")]
    pub resume: Option<ContinuedFileArg>,
    /// Do not drive; show rates, delays, image size, signs of the encoders (push the robot by hand) and tilt of the camera.
    #[arg(long, conflicts_with_all = ["goal", "explore", "dock", "mission", "resume"])]
    pub check: bool,
}

impl MissionArgs {
    /// The requested mission.
    pub fn request(&self) -> MissionRequest {
        let goals = self.goal.iter().map(|goal| goal.0).collect();
        MissionRequest { goals, explore: self.explore, dock: self.dock, file: self.mission.clone() }
    }
}
