use crate::{Outcome, args::Common, console, failure::Failure};
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;
use trundle::core::{Pose2, Stamp};
use trundle::io::{LaserLog, LaserLogOptions, OutputFolder, Summary, read_carmen, write_map};
use trundle::mapping::{MapperConfig, ParticleConfig, ParticleMapper, ScanUpdate, carry_trajectory};

/// `trundle map`
#[derive(Debug, Args)]
#[command(
    after_help = "Example: trundle map ../shared/data/laser/sena.log --laser-x 0.78 --out out/sena\n\n\
    Writes trajectory.txt (t x y theta: s, m, m, rad), map.pgm, map.yaml and summary.json."
)]
pub struct MapArgs {
    /// A CARMEN log: FLASER or ROBOTLASER1 lines, whose odometry is the motion.
    pub log: PathBuf,
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
    /// How far the laser is turned to the left, deg.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub laser_turn: Option<f64>,
    /// The laser hangs upside down.
    #[arg(long)]
    pub upside_down: bool,
    /// Ranges from here on are no returns, m [default: the reading at which many end]
    #[arg(long, value_name = "M")]
    pub max_range: Option<f64>,
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/map")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// What became of the scans.
#[derive(Debug, Default)]
struct Counts {
    processed: usize,
    refused: usize,
    jumps: usize,
    resamplings: usize,
    without_overlap: usize,
    degenerate: usize,
}

/// `trundle map LOG`.
pub fn run(args: &MapArgs) -> Result<Outcome, Failure> {
    let log = read_carmen(&args.log, &args.log_options())?;
    let folder = OutputFolder::create(&args.out)?;
    let mut mapper = ParticleMapper::new(args.config(), args.seed)?;
    let start = Instant::now();
    let counts = map(args, &log, &mut mapper);
    let seconds = start.elapsed().as_secs_f64();

    let odometry: Vec<(Stamp, Pose2)> =
        log.scans.iter().map(|s| (s.scan.stamp(), s.odom_from_base)).collect();
    let trajectory = carry_trajectory(&mapper.trajectory(), &odometry);
    folder.write("trajectory.txt", trajectory_text(&trajectory).as_bytes())?;
    let megabytes = mapper.bytes() as f64 / 1e6;
    write_map(&folder, "map", mapper.grid())?;
    folder.write("summary.json", summary(args, &log, &counts, megabytes, seconds).to_json().as_bytes())?;
    let place = folder.commit()?;
    if let Some(first) = log.skipped.first() {
        let (count, file) = (log.skipped.len(), args.log.display());
        console::warn(&format!(
            "{file}: {count} lines skipped, the first line {}: {}",
            first.line, first.problem
        ));
    }
    if !args.common.quiet {
        console::table(&rows(&log, &counts, megabytes, seconds));
        console::say(&format!("See {}", place.join("map.pgm").display()));
    }
    Ok(Outcome::Reached)
}

impl MapArgs {
    fn log_options(&self) -> LaserLogOptions {
        let placed = self.laser_x.is_some() || self.laser_turn.is_some();
        let turn = self.laser_turn.unwrap_or(0.0).to_radians();
        LaserLogOptions {
            base_from_laser: placed.then(|| Pose2::new(self.laser_x.unwrap_or(0.0), 0.0, turn)),
            upside_down: self.upside_down,
            max_range: self.max_range,
        }
    }

    fn config(&self) -> ParticleConfig {
        let default = ParticleConfig::default();
        ParticleConfig {
            particles: usize::from(self.particles),
            map: MapperConfig { resolution: self.resolution, ..default.map },
            ..default
        }
    }
}

fn map(args: &MapArgs, log: &LaserLog, mapper: &mut ParticleMapper) -> Counts {
    let mut counts = Counts::default();
    let bar = console::bar(args.common.quiet, log.scans.len());
    for entry in &log.scans {
        match mapper.update(entry.odom_from_base, &entry.scan) {
            ScanUpdate::Processed(done) => {
                counts.processed += 1;
                counts.jumps += usize::from(done.jumped);
                counts.resamplings += usize::from(done.resampled);
                counts.without_overlap += usize::from(done.degenerate == 3);
                counts.degenerate += usize::from(done.degenerate > 0);
            }
            ScanUpdate::Refused(_) => counts.refused += 1,
            ScanUpdate::Still => {}
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    counts
}

/// `t x y theta` lines.
fn trajectory_text(trajectory: &[(Stamp, Pose2)]) -> String {
    let mut text = String::new();
    for (stamp, pose) in trajectory {
        writeln!(text, "{stamp} {:.6} {:.6} {:.6}", pose.x, pose.y, pose.theta).expect("invariant: a String");
    }
    text
}

fn rows(log: &LaserLog, counts: &Counts, megabytes: f64, seconds: f64) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    vec![
        row("scans", log.scans.len().to_string()),
        row("processed", counts.processed.to_string()),
        row("odometry jumps", counts.jumps.to_string()),
        row("scans without overlap with the map", counts.without_overlap.to_string()),
        row("scans with a direction left to the odometry", counts.degenerate.to_string()),
        row("resamplings", counts.resamplings.to_string()),
        row("memory of maps and trajectories", format!("{megabytes:.1} MB")),
        row("time for a processed scan", format!("{:.2} ms", milliseconds(counts, seconds))),
    ]
}

fn milliseconds(counts: &Counts, seconds: f64) -> f64 {
    seconds * 1e3 / counts.processed.max(1) as f64
}

fn summary(args: &MapArgs, log: &LaserLog, counts: &Counts, megabytes: f64, seconds: f64) -> Summary {
    let mut summary = Summary::new("map");
    let milliseconds = milliseconds(counts, seconds);
    summary
        .set("success", true)
        .set("log", args.log.display().to_string())
        .set("particles", args.particles)
        .set("seed", args.seed)
        .set("scans", log.scans.len())
        .set("processed", counts.processed)
        .set("refused_scans", counts.refused)
        .set("skipped_lines", log.skipped.len())
        .set("bad_ranges", log.bad_ranges)
        .set("max_range_m", log.max_range)
        .set("odometry_jumps", counts.jumps)
        .set("scans_without_overlap", counts.without_overlap)
        .set("degenerate_scans", counts.degenerate)
        .set("resamplings", counts.resamplings)
        .set("memory_mb", megabytes)
        .set("wall_clock", serde_json::json!({ "total_s": seconds, "processed_scan_ms": milliseconds }));
    summary
}
