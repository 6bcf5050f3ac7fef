//! The command line of `trundle sim`.

use crate::common_args::{Common, NumberArg, NumberText, PlaceArgs, choice};
use crate::live::ViewArgs;
use crate::output_args::{OutputDirArg, OutputFileArg};
use clap::{ArgGroup, Args};
use std::path::PathBuf;
use trundle::app::AppError;
use trundle::experiments::simulated::read_faults;
use trundle::io::MapImage;
use trundle::live::LiveAddress;
use trundle::sim::{LaserConfig, SimConfig};

const LIVE_HELP: &str = "Show the drive in a browser, in real time: prints the link. Without another driver the page drives, by keys, \
                         stick or gamepad, until Ctrl-C or --duration. ADDR is IP:PORT [default: 127.0.0.1:8642, or a free port where it is in use]";

#[cfg(feature = "ros2")]
const ROS2_HELP: &str = "Be a ROS 2 robot, in real time, until Ctrl-C or --duration";
#[cfg(feature = "ros2")]
const ROS2_CONFLICTS: [&str; 5] = ["driver", "record", "map", "kobuki", "live"];

/// `trundle sim`
#[derive(Debug, Args)]
#[cfg_attr(feature = "ros2", command(mut_arg("ros2", |ros2| ros2.help(ROS2_HELP).conflicts_with_all(ROS2_CONFLICTS))))]
#[command(group = ArgGroup::new("map_use").multiple(true), mut_arg("live", |live| live.help(LIVE_HELP).group("map_use")))]
#[command(after_help = "Example: trundle sim office --follow waypoints.txt --record out/office\n\n\
    Exit code: 0 done, 1 a way-point was not reached, 2 bad input.")]
pub struct SimArgs {
    /// A built-in scene (--list), a scene file (.toml), a .glb or .gltf, or a map (.yaml) raised to walls.
    #[arg(required_unless_present = "list")]
    pub scene: Option<String>,
    /// Show the built-in scenes.
    #[arg(long)]
    pub list: bool,
    /// The room.
    #[command(flatten)]
    pub place: PlaceArgs,
    /// The driver.
    #[command(flatten)]
    pub driver: DriverArgs,
    /// The live page.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Write a TUM RGB-D folder: images, ground truth, odometry, calibration, the true map; the previous one is renamed to DIR.1
    #[arg(long, value_name = "DIR", group = "map_use")]
    pub record: Option<OutputDirArg>,
    /// The true map.
    #[command(flatten)]
    pub true_map: TrueMapArgs,
    /// Sensors, their faults and their noise.
    #[command(flatten)]
    pub sensors: SensorArgs,
    /// The wires of a real robot.
    #[command(flatten)]
    pub wires: WireArgs,
    /// The simulator as a ROS 2 robot.
    #[cfg(feature = "ros2")]
    #[command(flatten)]
    pub ros_robot: crate::ros_node::RosRobotArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// The driver of the simulated robot.
#[derive(Debug, Args)]
pub struct DriverArgs {
    /// Drive by commands, a line each: t v omega (s, m/s, rad/s).
    #[arg(long, value_name = "FILE", group = "driver")]
    pub drive: Option<PathBuf>,
    /// Drive to way-points, a line each: x y heading_deg (m, m, deg, world frame).
    #[arg(long, value_name = "FILE", group = "driver")]
    pub follow: Option<PathBuf>,
    /// Drive by keys in the terminal: arrows or WASD, space to stop, q to quit. The live page shows the robot's camera image.
    #[arg(long, groups = ["driver", "map_use"])]
    pub keys: bool,
    /// Stop after this simulated time, s, or at the end of the drive [default: 5 without a drive]
    #[arg(long, value_name = "S", value_parser = NumberArg(NumberText::up_to(1e6, "s")), allow_negative_numbers = true)]
    pub duration: Option<f64>,
}

/// The file of the true map.
#[derive(Debug, Args)]
pub struct TrueMapArgs {
    /// Write the true occupancy grid; without a drive, duration or recording, only this is done.
    #[arg(long, value_name = "FILE.yaml", group = "map_use")]
    pub map: Option<OutputFileArg>,
    /// Format of the true map's picture.
    #[arg(long, value_name = "FORMAT", default_value = "pgm", hide_short_help = true, requires = "map", value_parser = choice(&MapImage::CHOICES))]
    pub map_image: MapImage,
    /// Side of the map's cells, m.
    #[arg(long, value_name = "M", default_value_t = 0.05, requires = "map_use", value_parser = NumberArg(NumberText::CELL_SIDE), allow_negative_numbers = true)]
    pub resolution: f64,
    /// Height band of obstacles, m, for the map [default: the robot's]
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], hide_short_help = true, requires = "map_use", value_parser = NumberArg(NumberText::any("m")), allow_negative_numbers = true)]
    pub band: Option<Vec<f64>>,
}

/// The wires behind which the simulator is a real robot.
#[derive(Debug, Args)]
pub struct WireArgs {
    /// Emulate a Kobuki at a pseudo terminal, in real time, until Ctrl-C or --duration; LINK becomes a symbolic link to the terminal.
    #[arg(long, value_name = "LINK", conflicts_with_all = ["driver", "record", "map", "live"])]
    pub kobuki: Option<PathBuf>,
    /// Write the camera's frames into this FIFO (docs/camera-stream.md), which is created if missing.
    #[arg(long, value_name = "FIFO", requires = "kobuki")]
    pub camera_stream: Option<PathBuf>,
}

/// The sensors of the simulated robot.
#[derive(Debug, Args)]
pub struct SensorArgs {
    /// The camera.
    #[arg(long, default_value = "kinect-v2", value_parser = choice(&SimConfig::CAMERAS))]
    pub camera: fn() -> SimConfig,
    /// Images per second.
    #[arg(long, value_name = "HZ", value_parser = NumberArg(NumberText::above_zero("Hz")), allow_negative_numbers = true)]
    pub rate: Option<f64>,
    /// A 2-D laser on the robot.
    #[arg(long, value_name = "PRESET", value_parser = choice(&LaserConfig::PRESETS))]
    pub laser: Option<fn() -> LaserConfig>,
    /// Faults and their times: a TOML file of [[faults]].
    #[arg(long, value_name = "FILE")]
    pub faults: Option<PathBuf>,
    /// No noise in the sensors, perfect wheels.
    #[arg(long)]
    pub no_noise: bool,
}

impl SensorArgs {
    /// The simulated robot.
    ///
    /// # Errors
    /// When the fault file cannot be read or a value is outside its range.
    pub fn config(&self) -> Result<SimConfig, AppError> {
        let mut config = (self.camera)();
        config.camera_rate_hz = self.rate.unwrap_or(config.camera_rate_hz);
        config.laser = self.laser.map(|laser| laser());
        if let Some(file) = &self.faults {
            config.faults = read_faults(file)?;
        }
        let config = if self.no_noise { config.without_noise() } else { config };
        Ok(config.validated()?)
    }
}

impl SimArgs {
    /// Whether the true map is written or shown.
    pub fn needs_map(&self) -> bool {
        self.true_map.map.is_some() || self.record.is_some() || self.is_shown()
    }

    /// The page: one at the keys always has one.
    pub fn page_args(&self) -> ViewArgs {
        let default = self.driver.keys.then(LiveAddress::default);
        ViewArgs { live: self.live.live.or(default), ..self.live.clone() }
    }

    /// Whether a page shows the drive.
    pub fn is_shown(&self) -> bool {
        self.live.live.is_some() || self.driver.keys
    }

    /// Whether the page is the driver.
    pub fn is_driven_by_page(&self) -> bool {
        let has_driver = self.driver.drive.is_some() || self.driver.follow.is_some() || self.driver.keys;
        self.live.live.is_some() && !has_driver
    }

    /// Whether only the map is requested.
    pub fn wants_only_map(&self) -> bool {
        let drives = self.driver.drive.is_some() || self.driver.follow.is_some() || self.is_shown();
        self.true_map.map.is_some() && !drives && self.driver.duration.is_none() && self.record.is_none()
    }
}
