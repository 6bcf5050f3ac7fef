//! `trundle replay`: a repeated run of the robot on a recording, or a run on the sensors of a bag.

use crate::common_args::{BagTopicsArgs, Common, RobotArgs};
use crate::live::LiveArgs;
use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::slam::CameraArgs;
use crate::{console, logging, run_output};
use clap::Args;
use std::path::PathBuf;
use trundle::app::sequence_input::SequenceOptions;
use trundle::app::{AppError, ReplaySource, RunLog, RunRecorder, run_on_body};

/// `trundle replay`
#[derive(Debug, Args)]
#[command(after_help = "Examples: trundle replay out/demo/recording.mcap --out out/replay
          trundle replay bag --out out/replay")]
pub struct ReplayArgs {
    /// A recording made by trundle, with images (`trundle demo --record all`): the run is repeated. Or a ROS 2 bag or a TUM RGB-D folder
    /// with odometry and images or, in a bag, a laser: the robot locates itself and maps by these sensors; it has no mission.
    pub recording: PathBuf,
    /// Replay a recording that is cut, as by a power failure, up to the cut.
    #[arg(long)]
    pub recover: bool,
    /// The camera of a bag or a folder.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// The topics of a bag.
    #[command(flatten)]
    pub topics: BagTopicsArgs,
    /// The settings of the robot for a bag or a folder; a recording has its own.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/replay")]
    pub out: OutputDirArg,
    /// The live page, which accepts no commands.
    #[command(flatten)]
    pub live: LiveArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle replay RECORDING`.
pub fn run(args: &ReplayArgs) -> Result<Outcome, AppError> {
    let mut options =
        SequenceOptions::of_camera(&args.recording, args.camera.chosen(), args.topics.options());
    options.recover = args.recover;
    let source = ReplaySource::open(&options, args.robot.robot_if_given()?)?;
    let setup = source.setup().clone();
    let folder = logging::output_folder(&args.out)?;
    let recorder = RunRecorder::to_folder(&folder)?;
    let (line, progress) = console::progress(args.common.quiet);
    let (page, front_end) = args.live.front_ends(&setup, progress, None, false)?;
    let run = source.run(|body| run_on_body(&setup, body, recorder, RunLog::default(), front_end));
    line.finish_and_clear();
    drop(page);
    let (run, warnings) = run?;
    warnings.iter().for_each(|warning| console::warn(warning));
    run_output::write(&setup, run, None, folder, args.common.quiet)
}
