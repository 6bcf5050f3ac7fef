use crate::map::MapArgs;
use std::fmt::Write;
use trundle::core::{OccupancyGrid, Pose2, Stamp};
use trundle::io::{LaserLog, Summary};
use trundle::mapping::{Localized, Processed, ScanUpdate};
use trundle::viz::{Color, LineStyle, MapPicture, PoseStyle};

/// What became of the scans.
#[derive(Debug, Default)]
pub struct Counts {
    /// Scans looked at.
    pub processed: usize,
    /// Scans refused.
    pub refused: usize,
    jumps: usize,
    slips: usize,
    resamplings: usize,
    without_overlap: usize,
    degenerate: usize,
    bends: usize,
    lost: usize,
}

impl Counts {
    /// Counts what became of a scan.
    pub fn count(&mut self, update: &ScanUpdate) {
        match update {
            ScanUpdate::Processed(done) => self.count_processed(done),
            ScanUpdate::Refused(_) => self.refused += 1,
            ScanUpdate::Lost(_) => self.lost += 1,
            ScanUpdate::Found(_) => self.processed += 1,
            ScanUpdate::Still => {}
        }
    }

    /// The same in a map that does not change.
    pub fn count_localized(&mut self, localized: &Localized) {
        match localized {
            Localized::Known { degenerate, .. } => {
                self.processed += 1;
                self.without_overlap += usize::from(*degenerate == 3);
                self.degenerate += usize::from(*degenerate > 0);
            }
            Localized::Refused(_) => self.refused += 1,
            Localized::Lost(_) => self.lost += 1,
            Localized::Still => {}
        }
    }

    fn count_processed(&mut self, done: &Processed) {
        self.processed += 1;
        self.jumps += usize::from(done.jumped);
        self.slips += usize::from(done.slipped);
        self.resamplings += usize::from(done.resampled);
        self.without_overlap += usize::from(done.degenerate == 3);
        self.degenerate += usize::from(done.degenerate > 0);
        self.bends += usize::from(done.bent.is_some());
    }
}

/// Places nearer to each other than this part of the map's side have one name in its picture.
const TOGETHER: f64 = 0.12;

/// The map with the way and its ends. A PNG.
pub fn map_picture(grid: &OccupancyGrid, poses: &[(Stamp, Pose2)]) -> Vec<u8> {
    let way: Vec<_> = poses.iter().map(|(_, pose)| pose.position()).collect();
    let picture = MapPicture::over(grid).polyline("way", &way, LineStyle::solid(Color::BLUE));
    let (Some((_, start)), Some((_, end))) = (poses.first(), poses.last()) else { return picture.to_png() };
    let (first, last) = (PoseStyle::named(Color::GREEN), PoseStyle::named(Color::VERMILLION));
    // Where both are one place, one name says so: two would lie over each other.
    let geometry = grid.geometry();
    let side = geometry.width.max(geometry.height) as f64 * geometry.resolution;
    if start.distance(end) < TOGETHER * side {
        return picture.pose("start", *start, first.nameless()).pose("start and end", *end, last).to_png();
    }
    picture.pose("start", *start, first).pose("end", *end, last).to_png()
}

/// `t x y theta` lines.
pub fn trajectory_text(trajectory: &[(Stamp, Pose2)]) -> String {
    let mut text = String::new();
    for (stamp, pose) in trajectory {
        writeln!(text, "{stamp} {:.6} {:.6} {:.6}", pose.x, pose.y, pose.theta).expect("invariant: a String");
    }
    text
}

/// The table for the terminal.
pub fn rows(log: &LaserLog, counts: &Counts, megabytes: f64, seconds: f64) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    vec![
        row("scans", log.scans.len().to_string()),
        row("ranges that are negative, zero, infinite or no number", log.bad_ranges.to_string()),
        row("processed", counts.processed.to_string()),
        row("odometry jumps", counts.jumps.to_string()),
        row("steps where the odometry was not believed", counts.slips.to_string()),
        row("scans without overlap with the map", counts.without_overlap.to_string()),
        row("scans with a direction left to the odometry", counts.degenerate.to_string()),
        row("scans while the place was not known", counts.lost.to_string()),
        row("resamplings", counts.resamplings.to_string()),
        row("loops that bent the way", counts.bends.to_string()),
        row("memory of maps, scans and trajectories", format!("{megabytes:.1} MB")),
        row("time for a processed scan", format!("{:.2} ms", milliseconds(counts, seconds))),
    ]
}

fn milliseconds(counts: &Counts, seconds: f64) -> f64 {
    seconds * 1e3 / (counts.processed + counts.lost).max(1) as f64
}

/// `summary.json`.
pub fn summary(args: &MapArgs, log: &LaserLog, counts: &Counts, megabytes: f64, seconds: f64) -> Summary {
    let mut summary = Summary::new("map");
    let milliseconds = milliseconds(counts, seconds);
    summary
        .set("success", counts.processed > 0)
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
        .set("odometry_not_believed", counts.slips)
        .set("scans_without_overlap", counts.without_overlap)
        .set("degenerate_scans", counts.degenerate)
        .set("lost_scans", counts.lost)
        .set("resamplings", counts.resamplings)
        .set("bending_loops", counts.bends)
        .set("memory_mb", megabytes)
        .set("wall_clock", serde_json::json!({ "total_s": seconds, "processed_scan_ms": milliseconds }));
    summary
}
