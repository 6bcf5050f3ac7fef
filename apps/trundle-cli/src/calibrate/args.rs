//! The command line of `trundle calibrate`.

use crate::common_args::Common;
use crate::output_args::{EditedFileArg, OutputFileArg};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use trundle::vision::board::Board;

/// `trundle calibrate`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle calibrate mount out/demo/recording.mcap --write robot.toml")]
pub struct CalibrateArgs {
    /// The quantity to measure.
    #[command(subcommand)]
    pub command: CalibrateCommand,
}

/// The quantity to measure.
#[derive(Debug, Subcommand)]
pub enum CalibrateCommand {
    /// Intrinsics and lens of a camera, by images of a board.
    Camera(BoardImageArgs),
    /// A board to print, SVG in true size.
    Board(BoardSheetArgs),
    /// Pose of the camera on the base, by a drive with turns on the spot and straight parts.
    Mount(DriveArgs),
    /// Radius of the wheels and distance between them, from a drive with turns and straight parts.
    Wheels(DriveArgs),
    /// Delay of the image stamps, by a drive that starts and stops turning.
    Delay(DriveArgs),
}

/// A recording of a drive.
#[derive(Debug, Args)]
pub struct DriveArgs {
    /// A recording of trundle with images, wheels and gyro.
    pub recording: PathBuf,
    /// Read a recording that is cut, as by a power failure, up to the cut.
    #[arg(long)]
    pub recover: bool,
    /// Set the calibrated keys in this robot file; a missing file is created.
    #[arg(long, value_name = "FILE")]
    pub write: Option<EditedFileArg>,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// Images of a board.
#[derive(Debug, Args)]
pub struct BoardImageArgs {
    /// Images of the board, JPEG or PNG, or folders of them.
    #[arg(required = true)]
    pub images: Vec<PathBuf>,
    /// The board: checkerboard:9x6:25mm (inner corners, side of a square) or apriltag:6x6:88mm:0.3 (tags, side, gap over side)
    #[arg(long, value_name = "BOARD")]
    pub board: Board,
    /// Also estimate the third radial coefficient, for wide lenses
    #[arg(long)]
    pub k3: bool,
    /// Write a camera file, for `trundle slam --camera`.
    #[arg(long, value_name = "FILE")]
    pub write_camera: Option<OutputFileArg>,
    /// Set the camera in this robot file; a missing file is created.
    #[arg(long, value_name = "FILE")]
    pub write: Option<EditedFileArg>,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// A board to print.
#[derive(Debug, Args)]
pub struct BoardSheetArgs {
    /// The board: checkerboard:9x6:25mm or apriltag:6x6:88mm:0.3
    pub board: Board,
    /// The file to write, SVG.
    #[arg(long, value_name = "FILE")]
    pub out: OutputFileArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}
