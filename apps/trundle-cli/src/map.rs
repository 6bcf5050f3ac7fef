//! `trundle map`: the map of a laser log, a ROS 2 bag, a recording or an RGB-D folder, and the tools for finished maps.

mod laser_args;
mod tools;

use crate::common_args::{BagTopicsArgs, Common, NumberArg, NumberText, choice};
use crate::console;
use crate::live::ViewArgs;
use crate::logging;
use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use clap::Args;
use laser_args::LaserArgs;
use std::path::PathBuf;
use tools::MapTool;
use trundle::app::AppError;
use trundle::app::laser_map::{LaserMapRequest, map_log, map_rows, read_log};
use trundle::io::MapImage;
use trundle::live::RunFacts;

/// `trundle map`
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Example: trundle map ../shared/data/laser/sena.log --laser-x 0.78 --out out/sena\n\n\
    Writes trajectory.txt (t x y theta: s, m, m, rad), map.pgm, map.yaml, filter.map (--map extends it), overview.png and\n\
    summary.json."
)]
pub struct MapArgs {
    /// Work on finished maps.
    #[command(subcommand)]
    pub tool: Option<MapTool>,
    /// A log to be mapped.
    #[command(flatten)]
    pub log: MapLogArgs,
}

/// `trundle map LOG`
#[derive(Debug, Args)]
pub struct MapLogArgs {
    /// A CARMEN log (or .log.gz), a ROS 2 bag (folder, .mcap, .mcap.zst, .db3), a recording of trundle or a TUM RGB-D folder. Its odometry
    /// gives the motion.
    #[arg(required = true)]
    pub log: Option<PathBuf>,
    /// Read a recording of trundle that is cut, as by a power failure, up to the cut. A bag is always read up to its cut.
    #[arg(long, hide_short_help = true)]
    pub recover: bool,
    /// Motion of RGB-D images: the camera's trajectory from `trundle slam`, or another in TUM format. In a new map each pose is accepted
    /// with 1 cm and 0.003 rad (one sigma), and no loops are searched.
    #[arg(long, hide_short_help = true, value_name = "FILE")]
    pub poses: Option<PathBuf>,
    /// The --poses drift, as those of visual odometry without loop closure: only their steps are used, and loops are searched.
    #[arg(long, hide_short_help = true, requires = "poses")]
    pub poses_drift: bool,
    /// Number of particles of the filter.
    #[arg(long, hide_short_help = true, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub particles: u16,
    /// Format of the map's picture.
    #[arg(long, hide_short_help = true, value_name = "FORMAT", default_value = "pgm", value_parser = choice(&MapImage::CHOICES))]
    pub map_image: MapImage,
    /// Seed of the filter.
    #[arg(long, hide_short_help = true, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Side of a cell, m.
    #[arg(long, value_name = "M", default_value_t = 0.05, value_parser = NumberArg(NumberText::above_zero("m")), allow_negative_numbers = true)]
    pub resolution: f64,
    /// The laser of a log.
    #[command(flatten)]
    pub laser: LaserArgs,
    /// The topics of a bag.
    #[command(flatten)]
    pub topics: BagTopicsArgs,
    /// Continue the map of an earlier run, its filter.map, after localization of the robot in it.
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Only localize the robot in the --map, a filter.map or a map.yaml, which does not change.
    #[arg(long, requires = "map")]
    pub localise: bool,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/map")]
    pub out: OutputDirArg,
    /// The live page, which shows the growing map and accepts no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle map LOG`, or a tool.
pub fn run(args: &MapArgs) -> Result<Outcome, AppError> {
    args.tool.as_ref().map_or_else(|| map(&args.log), tools::run)
}

fn map(args: &MapLogArgs) -> Result<Outcome, AppError> {
    let request = args.request();
    request.refuse_wrong_options(args.laser.first_given())?;
    let display = console::StepDisplay::new(args.common.quiet);
    let folder = logging::output_folder(&args.out)?;
    let mut input = read_log(&request, &display)?;
    let (page, link) = args.live.start(|| Ok(RunFacts::of_log(&request.log)), false)?.unzip();
    let run = map_log(&request, args.localise, &mut input, &folder, &display, link)?;
    drop(page);
    let place = folder.commit()?;
    let warn = |problem: &String| console::warn(&format!("{}: {problem}", request.log.display()));
    run.warnings(&input.log).iter().for_each(warn);
    console::print_result(args.common.quiet, &map_rows(&input.log, &run), &place.join("overview.png"));
    Ok(Outcome::unless(run.failure.map(|failure| format!("{}: {failure}", request.log.display()))))
}

impl MapLogArgs {
    fn request(&self) -> LaserMapRequest {
        LaserMapRequest {
            log: self.log.clone().unwrap_or_default(),
            recover: self.recover,
            topics: self.topics.options(),
            poses: self.poses.clone(),
            poses_drift: self.poses_drift,
            particles: usize::from(self.particles),
            seed: self.seed,
            resolution: self.resolution,
            laser: self.laser.options(&self.topics),
            map: self.map.clone(),
            deskew: !self.laser.no_deskew,
            map_image: self.map_image,
        }
    }
}
