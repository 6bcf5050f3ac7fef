//! Mapping of a log, or localization of it in a map that does not change.

use super::counts::ScanCounts;
use super::known_stretches::KnownStretches;
use super::log_input::LogInput;
use super::mount_check::mount_hint;
use super::numbers::{map_picture, summary, trajectory_lines};
use super::request::LaserMapRequest;
use super::run_result::LaserMapRun;
use crate::{AppError, StepProgress, stop};
use std::time::Instant;
use trundle_core::{Pose2, Stamp};
use trundle_io::{LaserLog, OutputFolder, range_unit_hint, write_map_as};
use trundle_mapping::{Localized, MapLocalizer, ParticleMapper, ScanUpdate};

/// Maps a log, or with `localize_only` localizes the robot in the requested map; writes trajectory, map, picture and summary.
///
/// # Errors
/// When the map cannot be read, a setting is invalid or a file cannot be written.
pub fn map_log(
    request: &LaserMapRequest,
    localize_only: bool,
    input: &LogInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<LaserMapRun, AppError> {
    let LogInput { log, depth, .. } = input;
    let odometry: Vec<(Stamp, Pose2)> =
        log.scans.iter().map(|s| (s.scan.stamp(), s.odom_from_base)).collect();
    let start = Instant::now();
    let (counts, known, poses, megabytes, failure) = match &request.map {
        Some(file) if localize_only => {
            let mut localizer = request.localizer(file, depth.as_ref())?;
            let (counts, known, poses) = localize(log, &mut localizer, progress);
            folder.write("overview.png", &map_picture(&localizer.grid(), &poses))?;
            let failure = LaserMapRun::failure_of(log, &counts, None, stop::stopped().is_some());
            (counts, known, poses, 0.0, failure)
        }
        _ => {
            let mut mapper = request.mapper(depth.as_ref())?;
            let (counts, known) = map(log, &mut mapper, progress);
            write_map_as(folder, "map", mapper.grid(), request.map_image)?;
            let poses = mapper.whole_trajectory();
            folder.write("overview.png", &map_picture(mapper.grid(), &poses))?;
            folder.write("filter.map", &mapper.save())?;
            let failure =
                LaserMapRun::failure_of(log, &counts, Some(mapper.grid()), stop::stopped().is_some());
            (counts, known, poses, mapper.bytes() as f64 / 1e6, failure)
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let trajectory = known.trajectory(&poses, &odometry);
    folder.write("trajectory.txt", trajectory_lines(&trajectory).as_bytes())?;
    let is_interrupted = stop::stopped().is_some();
    let mount_hint = if depth.is_some() { None } else { mount_hint(log, &counts) };
    let run = LaserMapRun { counts, megabytes, seconds, is_interrupted, mount_hint, failure };
    folder.write("summary.json", summary(request, input, &run).to_json().as_bytes())?;
    Ok(run)
}

/// Whether the user has asked to stop before the scan `done`.
fn is_stopped(done: usize, log: &LaserLog) -> bool {
    stop::is_requested(|| format!("{done} of {} scans", log.scans.len()))
}

/// Number of scans without overlap after which a log of implausibly long ranges is not mapped any further: each of its scans takes a
/// thousand times the usual memory and time. Source: ours.
const MAX_SCANS_OF_WRONG_UNIT: usize = 10;

/// Maps the scans of the log.
fn map(
    log: &LaserLog,
    mapper: &mut ParticleMapper,
    progress: &dyn StepProgress,
) -> (ScanCounts, KnownStretches) {
    let (mut counts, mut known) = (ScanCounts::default(), KnownStretches::default());
    let is_unit_wrong = range_unit_hint(log).is_some();
    progress.begin(Some(log.scans.len()));
    for (done, entry) in log.scans.iter().enumerate() {
        if is_stopped(done, log) || (is_unit_wrong && counts.without_overlap >= MAX_SCANS_OF_WRONG_UNIT) {
            break;
        }
        let update = mapper.update(entry.odom_from_base, &entry.scan);
        counts.count(&update);
        match update {
            ScanUpdate::Paused(pause) => known.lose(pause.since),
            ScanUpdate::Found(_) => known.find(entry.scan.stamp()),
            _ => {}
        }
        progress.advance();
    }
    mapper.finish();
    progress.end();
    (counts, known)
}

/// The trajectory of the log in a map that does not change.
fn localize(
    log: &LaserLog,
    localizer: &mut MapLocalizer,
    progress: &dyn StepProgress,
) -> (ScanCounts, KnownStretches, Vec<(Stamp, Pose2)>) {
    let (mut counts, mut known, mut poses) = (ScanCounts::default(), KnownStretches::default(), Vec::new());
    progress.begin(Some(log.scans.len()));
    for (done, entry) in log.scans.iter().enumerate() {
        if is_stopped(done, log) {
            break;
        }
        let localized = localizer.update(entry.odom_from_base, &entry.scan);
        counts.count_localized(&localized);
        let stamp = entry.scan.stamp();
        match localized {
            Localized::Known { map_from_base, .. } => {
                known.find(stamp);
                poses.push((stamp, map_from_base));
            }
            Localized::Lost(_) => known.lose(stamp),
            Localized::Still | Localized::Refused(_) => {}
        }
        progress.advance();
    }
    progress.end();
    (counts, known, poses)
}
