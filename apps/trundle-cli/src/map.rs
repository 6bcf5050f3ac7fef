//! `trundle map`: the map of a laser log, a ROS 2 bag or an RGB-D folder.

use crate::common_args::Common;
use crate::console;
use crate::logging;
use crate::outcome::Outcome;
use clap::Args;
use std::path::PathBuf;
use trundle::app::AppError;
use trundle::app::laser_map::{LaserMapRequest, is_depth_folder, map_log, map_rows, read_log};
use trundle::io::{LaserLog, LaserLogOptions};

/// `trundle map`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle map ../shared/data/laser/sena.log --laser-x 0.78 --out out/sena\n\n\
    Writes trajectory.txt (t x y theta: s, m, m, rad), map.pgm, map.yaml, filter.map (to go on with by --map), overview.png and\n\
    summary.json."
)]
pub struct MapArgs {
    /// A CARMEN log, a ROS 2 bag (folder, .mcap, .db3) or a TUM RGB-D folder, whose odometry is the motion.
    pub log: PathBuf,
    /// The motion of an RGB-D folder: the camera's trajectory that `trundle slam` wrote, or another in TUM format. Each pose is
    /// believed to 1 cm and 0.003 rad (in a new map), and no loops are looked for.
    #[arg(long, value_name = "FILE")]
    pub poses: Option<PathBuf>,
    /// These poses drift, as of odometry by images that closes no loops: only their steps are believed, and loops are looked for.
    #[arg(long, requires = "poses")]
    pub poses_drift: bool,
    /// Particles of the filter.
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub particles: u16,
    /// Seed of the filter.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Side of a cell, m.
    #[arg(long, value_name = "M", default_value_t = 0.05)]
    pub resolution: f64,
    /// How far ahead of the base the laser sits, m [default: what the log says]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub laser_x: Option<f64>,
    /// How far the laser is turned to the left, deg [default: what the log says]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub laser_turn: Option<f64>,
    /// The laser hangs upside down.
    #[arg(long)]
    pub upside_down: bool,
    /// Ranges from here on are no returns, m [default: the reading at which many end]
    #[arg(long, value_name = "M")]
    pub max_range: Option<f64>,
    /// Go on with the map of an earlier run, its filter.map: the robot is looked for in it first.
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Only find the robot in that map, a filter.map or a map.yaml, and follow it: the map does not change.
    #[arg(long, requires = "map")]
    pub localise: bool,
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/map")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle map LOG`.
pub fn run(args: &MapArgs) -> Result<Outcome, AppError> {
    args.refuse_wrong_options()?;
    let request = args.request();
    let display = console::StepDisplay::new(args.common.quiet);
    let log = read_log(&request, &display)?;
    let folder = logging::output_folder(&args.out)?;
    let run = map_log(&request, args.localise, &log, &folder, &display)?;
    let place = folder.commit()?;
    warn_of_log(args, &log);
    if !args.common.quiet {
        console::print_table(&map_rows(&log, &run));
        console::print(&format!("See {}", place.join("overview.png").display()));
    }
    if run.counts.processed == 0 {
        console::warn("no scan was put into the map or found in it");
        return Ok(Outcome::Missed);
    }
    Ok(Outcome::Reached)
}

/// Logs entries that were skipped and ranges that cannot be.
fn warn_of_log(args: &MapArgs, log: &LaserLog) {
    let file = args.log.display();
    if let Some(first) = log.skipped.first() {
        let count = log.skipped.len();
        console::warn(&format!(
            "{file}: {count} entries skipped, the first {}: {}",
            first.line, first.problem
        ));
    }
    if let Some(first) = log.first_bad_range {
        let count = log.bad_ranges;
        console::warn(&format!(
            "{file}: {count} ranges are negative, zero, infinite or no number, the first in entry {first}: nothing is taken to be seen there"
        ));
    }
}

impl MapArgs {
    fn request(&self) -> LaserMapRequest {
        LaserMapRequest {
            log: self.log.clone(),
            poses: self.poses.clone(),
            poses_drift: self.poses_drift,
            particles: usize::from(self.particles),
            seed: self.seed,
            resolution: self.resolution,
            laser: LaserLogOptions {
                laser_x: self.laser_x,
                laser_turn: self.laser_turn.map(f64::to_radians),
                upside_down: self.upside_down,
                max_range: self.max_range,
            },
            map: self.map.clone(),
        }
    }

    /// Refuses options of a laser beside an RGB-D folder, and options of a camera beside a laser log.
    fn refuse_wrong_options(&self) -> Result<(), AppError> {
        let log = self.log.display();
        if !is_depth_folder(&self.log) {
            return match self.poses {
                Some(_) => Err(AppError::Input(format!(
                    "--poses is about the camera of an RGB-D folder, and {log} is none (it has no rgb.txt)"
                ))),
                None => Ok(()),
            };
        }
        match self.laser_option() {
            Some(option) => Err(AppError::Input(format!(
                "{option} is about a laser, but {log} is an RGB-D folder: its camera.toml says what the camera is, and the camera \
                 sits as on the default robot, or where groundtruth.txt says"
            ))),
            None => Ok(()),
        }
    }

    /// The first given option of a laser.
    fn laser_option(&self) -> Option<&'static str> {
        let options = [
            ("--laser-x", self.laser_x.is_some()),
            ("--laser-turn", self.laser_turn.is_some()),
            ("--upside-down", self.upside_down),
            ("--max-range", self.max_range.is_some()),
        ];
        options.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name)
    }
}
