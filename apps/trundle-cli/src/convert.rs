//! `trundle convert`: RGB-D images with their poses, in another format.

use crate::common_args::{BagTopicsArgs, Common};
use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::slam::CameraArgs;
use crate::{console, logging};
use clap::Args;
use std::path::PathBuf;
use trundle::app::AppError;
use trundle::app::convert::{ConversionInput, SequenceForm};
use trundle::app::sequence_input::{SequenceOptions, topic_rows};

/// `trundle convert`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle convert bag.mcap out/tum --to tum")]
pub struct ConvertArgs {
    /// A ROS 2 bag (folder, .mcap, .db3), a TUM RGB-D folder, a recording of trundle with images, or for --to tum the recording of a camera: kinect2-dump:FILE, realsense:FILE.db3, stream:FILE.
    pub input: PathBuf,
    /// Folder for the result.
    #[arg(required_unless_present = "list")]
    pub out: Option<OutputDirArg>,
    /// tum: a TUM RGB-D folder. bag: bag.mcap, a ROS 2 bag. recording: recording.mcap with all sensors, which `trundle replay` runs; it needs odometry.
    #[arg(long, value_name = "FORM", default_value = "tum")]
    pub to: SequenceForm,
    /// Only list the topics of a bag or a recording: name, type, messages, encoding of images, use in `trundle replay`.
    #[arg(long)]
    pub list: bool,
    /// The camera.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// The topics of a bag.
    #[command(flatten)]
    pub topics: BagTopicsArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle convert IN OUT`.
pub fn run(args: &ConvertArgs) -> Result<Outcome, AppError> {
    let options = SequenceOptions::of_camera(&args.input, args.camera.chosen(), args.topics.options());
    let Some(out) = args.out.as_ref().filter(|_| !args.list) else {
        console::print_table(&topic_rows(&options)?);
        return Ok(Outcome::Reached);
    };
    let input = ConversionInput::open(&options, args.to)?;
    let folder = logging::output_folder(out)?;
    let display = console::StepDisplay::new(args.common.quiet);
    let converted = input.convert(args.to, &folder, &display)?;
    let place = folder.commit()?;
    if !args.common.quiet {
        console::print(&format!("{converted}: {}", place.display()));
    }
    Ok(Outcome::Reached)
}
