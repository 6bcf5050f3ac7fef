//! The command line of `trundle slam`.

use crate::common_args::{BagTopicsArgs, Common, NumberArg, NumberText, RobotArgs, choice};
use crate::live::ViewArgs;
use crate::output_args::{OutputDirArg, ResultFileArg};
use clap::Args;
use std::path::PathBuf;
use trundle::app::RecordingContent;
use trundle::io::MapImage;

/// `trundle slam`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle slam ../shared/data/tum_fr1_rpy_400 --height 1.57 --tilt 33 --roll=-37"
)]
pub struct SlamArgs {
    /// A TUM RGB-D folder (rgb.txt and depth.txt, or associations.txt; optional groundtruth.txt and odometry.txt), a ROS
    /// 2 bag (folder, .mcap, .db3), or a recording of trundle with images.
    pub input: PathBuf,
    /// Read a recording of trundle that is cut, as by a power failure, up to the cut.
    #[arg(long)]
    pub recover: bool,
    /// The camera.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// The topics of a bag.
    #[command(flatten)]
    pub topics: BagTopicsArgs,
    /// Maximum number of frames.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// The pose of the first camera.
    #[command(flatten)]
    pub first_camera: FirstCameraArgs,
    /// Begin with the visual map of an earlier run (its visual.map), and localize the camera in it
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Only localize the camera in the --map, which does not change
    #[arg(long, requires = "map")]
    pub localise: bool,
    /// Recognise places by this vocabulary, in trundle's form [default: the built-in one]
    #[arg(long, value_name = "FILE")]
    pub vocabulary: Option<PathBuf>,
    /// The settings of tracking, odometry, mount and map.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Seed of the random sampling.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// The output.
    #[command(flatten)]
    pub result: SlamResultArgs,
    /// The surface in the camera's images.
    #[command(flatten)]
    pub surface: SurfaceArgs,
    /// The live page, which shows the tracking and accepts no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// The output of `trundle slam`.
#[derive(Debug, Args)]
pub struct SlamResultArgs {
    /// Write only the poses in the last visual map [default: all frames, by images and odometry, if the input has odometry]
    #[arg(long)]
    pub visual_only: bool,
    /// Format of the map's picture.
    #[arg(long, value_name = "FORMAT", default_value = "pgm", value_parser = choice(&MapImage::CHOICES))]
    pub map_image: MapImage,
    /// Content of recording.mcap: all, events (without images) or none (no file).
    #[arg(long, value_name = "WHAT", default_value = "all", value_parser = choice(&RecordingContent::CHOICES))]
    pub record: RecordingContent,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/slam")]
    pub out: OutputDirArg,
}

/// The surface in the camera's images, along the final trajectory.
#[derive(Debug, Args)]
pub struct SurfaceArgs {
    /// Write the surface as triangles with colours, .glb or .ply
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<ResultFileArg>,
    /// Write the surface as points with colours and normals, .ply
    #[arg(long, value_name = "FILE")]
    pub cloud: Option<ResultFileArg>,
    /// Write free and occupied voxels in OctoMap's binary form, .bt
    #[arg(long, value_name = "FILE")]
    pub octomap: Option<ResultFileArg>,
    /// Write heights over the floor as a 16-bit .png, with a FILE.yaml beside it
    #[arg(long, value_name = "FILE")]
    pub heights: Option<ResultFileArg>,
    /// Side of a voxel of the surface, m, 0.004 to 0.5 [default: 0.02]
    #[arg(long, value_name = "M", hide_short_help = true, value_parser = NumberArg(NumberText::above_zero("m")), allow_negative_numbers = true)]
    pub voxel: Option<f64>,
}

/// The pose of the first camera.
#[derive(Debug, Args)]
pub struct FirstCameraArgs {
    /// Height of the first camera above the floor, m, for the map; with odometry, a value off by over 2 cm from the floor in the images is
    /// replaced, with a warning [default: the recorded robot's, else by the floor in the images, else 1]
    #[arg(long, value_name = "M", value_parser = NumberArg(NumberText::any("m")), allow_negative_numbers = true)]
    pub height: Option<f64>,
    /// Downward tilt of the first camera, deg, for the map [default: as the height, else 0]
    #[arg(long, value_name = "DEG", value_parser = NumberArg(NumberText::any("deg")), allow_negative_numbers = true)]
    pub tilt: Option<f64>,
    /// Roll of the first camera to its right, deg, for the map [default: as the height, else 0]
    #[arg(long, value_name = "DEG", value_parser = NumberArg(NumberText::any("deg")), allow_negative_numbers = true)]
    pub roll: Option<f64>,
}

/// The camera of the images.
#[derive(Debug, Args)]
pub struct CameraArgs {
    /// Preset freiburg1, freiburg2, freiburg3, kinect_v2, or a camera file of trundle, ORB-SLAM, stella_vslam, Kalibr, ROS or Open3D
    /// [default: the recording's, or the one in the folder, camera.toml first, else freiburg1 with a warning]
    #[arg(long, value_name = "PRESET|FILE")]
    pub camera: Option<String>,
    /// Depth units per metre [default: the camera's]
    #[arg(long, value_name = "N", value_parser = NumberArg(NumberText::above_zero("units per metre")), allow_negative_numbers = true)]
    pub depth_scale: Option<f64>,
}

impl CameraArgs {
    /// Preset or file, and depth units per metre.
    pub fn chosen(&self) -> (Option<&str>, Option<f64>) {
        (self.camera.as_deref(), self.depth_scale)
    }
}
