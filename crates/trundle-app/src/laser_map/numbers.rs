//! The numbers and the picture of a mapped log.

use super::log_input::LogInput;
use super::request::LaserMapRequest;
use super::run_result::LaserMapRun;
use std::collections::BTreeMap;
use std::io;
use trundle_core::{OccupancyGrid, Pose2, Stamp};
use trundle_io::{LaserLog, LaserLogSources, Summary};
use trundle_viz::{Color, LineStyle, MapPicture, PoseStyle};

/// Share of the map's side below which start and end of a trajectory have one label in the picture. Source: ours.
const MIN_LABEL_DISTANCE_SHARE: f64 = 0.12;

/// The map with the trajectory and its ends. A PNG.
pub fn map_picture(grid: &OccupancyGrid, poses: &[(Stamp, Pose2)]) -> Vec<u8> {
    let path: Vec<_> = poses.iter().map(|(_, pose)| pose.position()).collect();
    let picture = MapPicture::over(grid).polyline("path", &path, LineStyle::solid(Color::BLUE));
    let (Some((_, start)), Some((_, end))) = (poses.first(), poses.last()) else { return picture.to_png() };
    let (first, last) = (PoseStyle::named(Color::GREEN), PoseStyle::named(Color::VERMILLION));
    // Two labels at one position would overlap.
    let geometry = grid.geometry();
    let side = geometry.width.max(geometry.height) as f64 * geometry.resolution;
    if start.distance(end) < MIN_LABEL_DISTANCE_SHARE * side {
        return picture.pose("start", *start, first.nameless()).pose("start and end", *end, last).to_png();
    }
    picture.pose("start", *start, first).pose("end", *end, last).to_png()
}

/// Writes `t x y theta` lines: s, m, m, rad.
///
/// # Errors
/// Those of `file`.
pub fn write_trajectory_lines(
    file: &mut dyn io::Write,
    trajectory: impl Iterator<Item = (Stamp, Pose2)>,
) -> io::Result<()> {
    for (stamp, pose) in trajectory {
        writeln!(file, "{stamp} {:.6} {:.6} {:.6}", pose.x, pose.y, pose.theta)?;
    }
    Ok(())
}

/// The table of a mapped log.
#[must_use]
pub fn map_rows(log: &LaserLog, run: &LaserMapRun) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let counts = &run.counts;
    let mut rows = source_rows(&log.sources);
    rows.extend([
        row("scans", counts.in_log.to_string()),
        row("scans read", counts.read.to_string()),
        row("entries that could not be used", log.skipped.len().to_string()),
        row("scans without a return", log.scans_without_return().to_string()),
        row("invalid ranges", log.bad_ranges.to_string()),
        row("processed", counts.processed.to_string()),
        row("odometry jumps", counts.jumps.to_string()),
        row("odometry steps rejected", counts.slips.to_string()),
        row("scans without overlap with the map", counts.without_overlap.to_string()),
        row("scans with a degenerate direction", counts.degenerate.to_string()),
        row("scans at an unknown pose", counts.lost.to_string()),
        row("pauses where scans contradict the given map", counts.pauses.to_string()),
        row("scans left out by pauses", counts.left_out.to_string()),
        row("resamplings", counts.resamplings.to_string()),
        row("loop closures that corrected the trajectory", counts.corrections.to_string()),
        row("memory of maps, scans and trajectories", format!("{:.1} MB", run.megabytes)),
        row("time for a processed scan", format!("{:.2} ms", run.scan_ms())),
    ]);
    rows
}

/// The topics of the scans and of the odometry, and the unused topics. No rows if the log has no topics.
fn source_rows(sources: &LaserLogSources) -> Vec<Vec<String>> {
    let left: Vec<String> = sources.left.iter().map(|(topic, count)| format!("{topic} ({count})")).collect();
    let rows = [
        ("scans are from", sources.scans.clone()),
        ("odometry is from", sources.odometry.clone()),
        ("unused topics", left.join(", ")),
    ];
    let rows = rows.into_iter().filter(|(_, value)| !value.is_empty());
    rows.map(|(name, value)| vec![name.to_owned(), value]).collect()
}

/// The name of a topic; `None` without one.
fn topic(name: &str) -> Option<&str> {
    Some(name).filter(|name| !name.is_empty())
}

/// `summary.json`.
pub fn summary(request: &LaserMapRequest, input: &LogInput, run: &LaserMapRun) -> Summary {
    let log = &input.log;
    let mut summary = Summary::new("map");
    let counts = &run.counts;
    summary
        .set("success", run.failure.is_none() && !run.is_interrupted)
        .set("failure", run.failure.clone())
        .set("log", request.log.display().to_string())
        .set("cut", input.cut_report.clone())
        .set("particles", request.particles)
        .set("seed", request.seed)
        .set("scan_topic", topic(&log.sources.scans))
        .set("odometry_topic", topic(&log.sources.odometry))
        .set("topics_left", serde_json::json!(log.sources.left.iter().cloned().collect::<BTreeMap<_, _>>()))
        .set("scans", counts.in_log)
        .set("scans_read", counts.read)
        .set("scans_without_return", log.scans_without_return())
        .set("processed", counts.processed)
        .set("refused_scans", counts.refused)
        .set("skipped_lines", log.skipped.len())
        .set("bad_ranges", log.bad_ranges)
        .set("max_range_m", log.max_range)
        .set("odometry_jumps", counts.jumps)
        .set("odometry_not_believed", counts.slips)
        .set("mount_hint", run.mount_hint.clone())
        .set("scans_without_overlap", counts.without_overlap)
        .set("degenerate_scans", counts.degenerate)
        .set("lost_scans", counts.lost)
        .set("pauses", counts.pauses)
        .set("left_out_scans", counts.left_out)
        .set("first_pause_s", counts.first_pause.map(|stamp| stamp.as_secs()))
        .set("resamplings", counts.resamplings)
        .set("loop_corrections", counts.corrections)
        .set("memory_mb", run.megabytes)
        .set("wall_clock", serde_json::json!({ "total_s": run.seconds, "processed_scan_ms": run.scan_ms() }))
        .set_interrupted(run.is_interrupted);
    summary
}
