//! The command line of `trundle demo`.

use crate::common_args::{Common, NumberArg, NumberText, PlaceArgs, PoseArg, RobotArgs, choice};
use crate::live::LiveArgs;
use crate::output_args::{OutputDirArg, OutputFileArg};
use clap::Args;
use std::path::PathBuf;
use trundle::app::RecordingContent;

/// `trundle demo`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle demo --seed 3 --direct --out out/demo3\n\n\
    Exit code: 0 goal reached and nothing touched, 1 otherwise, 2 bad input.")]
pub struct DemoArgs {
    /// The room: a built-in scene (`trundle sim --list`), a scene file, a .glb or .gltf, or a map (.yaml) raised to walls.
    #[arg(long, value_name = "SCENE", default_value = "demo")]
    pub scene: String,
    /// The room.
    #[command(flatten)]
    pub place: PlaceArgs,
    /// The mission.
    #[command(flatten)]
    pub mission: DemoMissionArgs,
    /// In real time: simulator and robot on their own threads, camera at 30 Hz; Ctrl-C stops the robot and ends the run.
    #[arg(long)]
    pub real_time: bool,
    /// The file that stores the robot's state.
    #[command(flatten)]
    pub state: CheckpointArgs,
    /// Content of recording.mcap; a replay needs all. Below 1 GB of free disk the run continues without recording.
    #[arg(long, value_name = "WHAT", default_value = "events", value_parser = choice(&RecordingContent::CHOICES))]
    pub record: RecordingContent,
    /// Recognise places by this vocabulary, in trundle's form [default: the built-in one]
    #[arg(long, value_name = "FILE")]
    pub vocabulary: Option<PathBuf>,
    /// Faults and their times: a TOML file as for `trundle sim --faults`.
    #[arg(long, value_name = "FILE")]
    pub faults: Option<PathBuf>,
    /// End the run after this time of the robot, s [default: 600 per goal, 1800 for exploring]
    #[arg(long, value_name = "S", value_parser = NumberArg(NumberText::above_zero("s")), allow_negative_numbers = true)]
    pub time_limit: Option<f64>,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/demo")]
    pub out: OutputDirArg,
    /// The live page; with it the demo runs in real time.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// The mission of a demo.
#[derive(Debug, Args)]
pub struct DemoMissionArgs {
    /// Goal in the map frame, which starts at the robot: m, m, deg; may be repeated [default: the scene's own]
    #[arg(long, value_name = "X,Y,DEG", allow_hyphen_values = true)]
    pub goal: Vec<PoseArg>,
    /// Drive straight to the goal, mapping during the drive [default: explore until the map is complete, drive to the goals, return]
    #[arg(long)]
    pub direct: bool,
    /// Drive onto the charging station at the end; with --direct and without --goal this is the only task.
    #[arg(long)]
    pub dock: bool,
}

/// The state of a robot, written and read.
#[derive(Debug, Args)]
pub struct CheckpointArgs {
    /// Write the robot's maps and the state of its mission to FILE, every 3 to 10 s: `--resume` continues from it.
    #[arg(long, value_name = "FILE", alias = "memory")]
    pub checkpoint: Option<OutputFileArg>,
    /// Resume from the file of --checkpoint with the robot at this pose in the scene (m, m, deg): the robot localizes itself in its maps
    /// and continues its mission. The map's frame is still that of --start.
    #[arg(long, value_name = "X,Y,DEG", alias = "wake", allow_hyphen_values = true, requires = "checkpoint", conflicts_with_all = ["goal", "direct"])]
    pub resume: Option<PoseArg>,
}
