use crate::map_output::{Counts, map_picture, rows, summary, trajectory_text};
use crate::{Outcome, args::Common, console, map_input};
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;
use trundle::app::AppError;
use trundle::core::{Pose2, Stamp};
use trundle::io::{LaserLog, LaserLogOptions, OutputFolder, read_map, write_map};
use trundle::mapping::{
    Localized, MapLocalizer, MapperConfig, ParticleConfig, ParticleMapper, propagate_trajectory,
};

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
    let log = map_input::read(args, &args.log_options())?;
    let folder = OutputFolder::create(&args.out)?;
    let odometry: Vec<(Stamp, Pose2)> =
        log.scans.iter().map(|s| (s.scan.stamp(), s.odom_from_base)).collect();
    let start = Instant::now();
    let (counts, poses, megabytes) = match (&args.map, args.localise) {
        (Some(file), true) => {
            let mut localizer = localizer(args, file)?;
            let (counts, poses) = localise(args, &log, &mut localizer);
            folder.write("overview.png", &map_picture(&localizer.grid(), &poses))?;
            (counts, poses, 0.0)
        }
        _ => {
            let mut mapper = begin(args)?;
            let counts = map(args, &log, &mut mapper);
            write_map(&folder, "map", mapper.grid())?;
            let way = mapper.trajectory();
            folder.write("overview.png", &map_picture(mapper.grid(), &way))?;
            folder.write("filter.map", &mapper.save())?;
            (counts, way, mapper.bytes() as f64 / 1e6)
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let trajectory = propagate_trajectory(&poses, &odometry);
    folder.write("trajectory.txt", trajectory_text(&trajectory).as_bytes())?;
    folder.write("summary.json", summary(args, &log, &counts, megabytes, seconds).to_json().as_bytes())?;
    let place = folder.commit()?;
    if let Some(first) = log.skipped.first() {
        let (count, file) = (log.skipped.len(), args.log.display());
        console::warn(&format!(
            "{file}: {count} entries skipped, the first {}: {}",
            first.line, first.problem
        ));
    }
    if let Some(first) = log.first_bad_range {
        let (count, file) = (log.bad_ranges, args.log.display());
        console::warn(&format!(
            "{file}: {count} ranges are negative, zero, infinite or no number, the first in entry {first}: nothing is taken to be seen there"
        ));
    }
    if !args.common.quiet {
        console::print_table(&rows(&log, &counts, megabytes, seconds));
        console::print(&format!("See {}", place.join("overview.png").display()));
    }
    if counts.processed == 0 {
        console::warn("no scan was put into the map or found in it");
        return Ok(Outcome::Missed);
    }
    Ok(Outcome::Reached)
}

impl MapArgs {
    fn log_options(&self) -> LaserLogOptions {
        LaserLogOptions {
            laser_x: self.laser_x,
            laser_turn: self.laser_turn.map(f64::to_radians),
            upside_down: self.upside_down,
            max_range: self.max_range,
        }
    }

    /// The options of those given that say something about a laser.
    pub fn given_laser_options(&self) -> Vec<&'static str> {
        let given = [
            ("--laser-x", self.laser_x.is_some()),
            ("--laser-turn", self.laser_turn.is_some()),
            ("--upside-down", self.upside_down),
            ("--max-range", self.max_range.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(name, _)| name).collect()
    }

    fn config(&self) -> Result<ParticleConfig, AppError> {
        let default = ParticleConfig::default();
        let config = ParticleConfig {
            particles: usize::from(self.particles),
            map: MapperConfig { resolution: self.resolution, ..default.map },
            ..default
        };
        map_input::tuned(self, config)
    }
}

/// The filter that was asked for: a new one, or one that goes on with a saved map.
fn begin(args: &MapArgs) -> Result<ParticleMapper, AppError> {
    let Some(file) = &args.map else { return Ok(ParticleMapper::new(args.config()?, args.seed)?) };
    let bytes = std::fs::read(file).map_err(|error| refused(file, &error))?;
    let mut mapper = ParticleMapper::load(&bytes, args.config()?).map_err(|error| refused(file, &error))?;
    mapper.kidnapped();
    Ok(mapper)
}

fn refused(file: &Path, problem: &dyn std::fmt::Display) -> AppError {
    AppError::Input(format!("{}: {problem}", file.display()))
}

fn map(args: &MapArgs, log: &LaserLog, mapper: &mut ParticleMapper) -> Counts {
    let mut counts = Counts::default();
    let bar = console::bar(args.common.quiet, log.scans.len());
    for entry in &log.scans {
        counts.count(&mapper.update(entry.odom_from_base, &entry.scan));
        bar.inc(1);
    }
    mapper.finish();
    bar.finish_and_clear();
    counts
}

/// The trajectory of the log in a map that does not change.
fn localise(args: &MapArgs, log: &LaserLog, localizer: &mut MapLocalizer) -> (Counts, Vec<(Stamp, Pose2)>) {
    let (mut counts, mut known) = (Counts::default(), Vec::new());
    let bar = console::bar(args.common.quiet, log.scans.len());
    for entry in &log.scans {
        let localized = localizer.update(entry.odom_from_base, &entry.scan);
        counts.count_localized(&localized);
        if let Localized::Known { map_from_base, .. } = localized {
            known.push((entry.scan.stamp(), map_from_base));
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    (counts, known)
}

/// The map to be localised in: a saved filter, or a grid by its YAML.
fn localizer(args: &MapArgs, file: &Path) -> Result<MapLocalizer, AppError> {
    if file.extension().is_some_and(|ext| ext == "yaml") {
        let grid = read_map(file)?;
        let resolution = grid.geometry().resolution;
        let config = args.config()?;
        let config = ParticleConfig { map: MapperConfig { resolution, ..config.map }, ..config };
        return Ok(MapLocalizer::from_grid(&grid, config, args.seed)?);
    }
    let bytes = std::fs::read(file).map_err(|error| refused(file, &error))?;
    MapLocalizer::load(&bytes, args.config()?, args.seed).map_err(|error| refused(file, &error))
}
