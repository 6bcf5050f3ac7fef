//! Mapping of a log, or localization of it in a map that does not change.

use super::counts::ScanCounts;
use super::known_stretches::KnownStretches;
use super::live_view::LogFeed;
use super::log_input::LogInput;
use super::mount_check::mount_hint;
use super::mount_steps::MountSteps;
use super::numbers::{map_picture, summary, write_trajectory_lines};
use super::request::LaserMapRequest;
use super::run_result::LaserMapRun;
use crate::operator::OperatorLink;
use crate::{AppError, StepProgress, stop};
use std::sync::Arc;
use std::time::Instant;
use trundle_core::{OccupancyGrid, Pose2, Stamp};
use trundle_io::{LaserLogScan, OutputFolder, range_unit_hint, write_map_as};
use trundle_mapping::{Localized, MapLocalizer, ParticleMapper, ScanUpdate};

/// What remains of the scans of a log after their processing.
#[derive(Debug, Default)]
struct ProcessedLog {
    counts: ScanCounts,
    known: KnownStretches,
    /// odom_from_base at each scan.
    odometry: Vec<(Stamp, Pose2)>,
    /// map_from_base at the processed scans.
    poses: Vec<(Stamp, Pose2)>,
    steps: MountSteps,
    /// Memory of maps, scans and trajectories, MB.
    megabytes: f64,
}

/// Maps a log, or with `localize_only` localizes the robot in the requested map; writes trajectory, map, picture and summary. A front end of
/// `link` watches the work.
///
/// # Errors
/// When the log or the map cannot be read, a setting is invalid or a file cannot be written.
pub fn map_log(
    request: &LaserMapRequest,
    localize_only: bool,
    input: &mut LogInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
    link: Option<OperatorLink>,
) -> Result<LaserMapRun, AppError> {
    let start = Instant::now();
    let mut feed = link.map(LogFeed::new);
    let (done, failure) = match &request.map {
        Some(file) if localize_only => {
            let mut localizer = request.localizer(file, input.depth.as_ref())?;
            let done = localize(input, &mut localizer, progress, feed.as_mut())?;
            folder.write("overview.png", &map_picture(&localizer.grid(), &done.poses))?;
            let failure = failure(input, &done, None);
            (done, failure)
        }
        _ => {
            let mut mapper = request.mapper(input.depth.as_ref())?;
            let done = map(input, &mut mapper, progress, feed.as_mut())?;
            write_map_as(folder, "map", mapper.grid(), request.map_image)?;
            folder.write("overview.png", &map_picture(mapper.grid(), &done.poses))?;
            folder.write("filter.map", &mapper.save())?;
            let failure = failure(input, &done, Some(mapper.grid()));
            (done, failure)
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let ProcessedLog { counts, known, odometry, poses, steps, megabytes } = done;
    let trajectory = known.trajectory(&poses, &odometry);
    folder.write_pieces("trajectory.txt", |file| write_trajectory_lines(file, trajectory))?;
    let is_interrupted = stop::stopped().is_some();
    let mount_hint = if input.depth.is_some() { None } else { mount_hint(input.log.mount, steps, &counts) };
    let run = LaserMapRun { counts, megabytes, seconds, is_interrupted, mount_hint, failure };
    folder.write("summary.json", summary(request, input, &run).to_json().as_bytes())?;
    Ok(run)
}

fn failure(input: &LogInput, done: &ProcessedLog, grid: Option<&OccupancyGrid>) -> Option<String> {
    LaserMapRun::failure_of(&input.log, &done.counts, grid, stop::stopped().is_some())
}

/// Whether the user has asked to stop before the scan `done`.
fn is_stopped(done: usize, input: &LogInput) -> bool {
    stop::is_requested(|| format!("{done} of {} scans", input.scan_count()))
}

/// Number of scans without overlap after which a log of implausibly long ranges is not mapped any further: each of its scans takes a
/// thousand times the usual memory and time. Source: ours.
const MAX_SCANS_OF_WRONG_UNIT: usize = 10;

/// Maps the scans of the log, and polishes trajectory and map.
fn map(
    input: &mut LogInput,
    mapper: &mut ParticleMapper,
    progress: &dyn StepProgress,
    mut feed: Option<&mut LogFeed>,
) -> Result<ProcessedLog, AppError> {
    let (mut done, mut is_unit_wrong) = (ProcessedLog::default(), None);
    for_each_scan(input, progress, &mut done, |input, done, entry| {
        let update = mapper.update(entry.odom_from_base, &entry.scan);
        done.counts.count(&update);
        match update {
            ScanUpdate::Paused(pause) => done.known.lose(pause.since),
            ScanUpdate::Found(_) => done.known.find(entry.scan.stamp()),
            _ => {}
        }
        if let Some(feed) = &mut feed {
            feed.note_mapped(&entry.scan, &done.counts, input.scan_count(), mapper);
        }
        done.counts.without_overlap < MAX_SCANS_OF_WRONG_UNIT
            || !*is_unit_wrong.get_or_insert_with(|| range_unit_hint(&input.log).is_some())
    })?;
    if is_unit_wrong != Some(true) {
        let scans = done.counts.read;
        let goes_on = || !stop::is_requested(|| format!("{scans} of {scans} scans, before their polish"));
        match mapper.polish(&goes_on) {
            Some(farthest) => tracing::info!("the polish moved poses by up to {farthest:.3} m"),
            None => tracing::info!("the trajectory is that of the filter, without a polish"),
        }
    }
    mapper.finish();
    progress.end();
    done.poses = mapper.whole_trajectory();
    done.megabytes = mapper.bytes() as f64 / 1e6;
    Ok(done)
}

/// The trajectory of the log in a map that does not change.
fn localize(
    input: &mut LogInput,
    localizer: &mut MapLocalizer,
    progress: &dyn StepProgress,
    mut feed: Option<&mut LogFeed>,
) -> Result<ProcessedLog, AppError> {
    let mut done = ProcessedLog::default();
    for_each_scan(input, progress, &mut done, |input, done, entry| {
        let localized = localizer.update(entry.odom_from_base, &entry.scan);
        done.counts.count_localized(&localized);
        let stamp = entry.scan.stamp();
        match localized {
            Localized::Known { map_from_base, .. } => {
                done.known.find(stamp);
                done.poses.push((stamp, map_from_base));
            }
            Localized::Lost(_) => done.known.lose(stamp),
            Localized::Still | Localized::Refused(_) => {}
        }
        if let Some(feed) = &mut feed {
            let pose = done.poses.last().filter(|_| done.known.is_known()).map(|(_, pose)| *pose);
            feed.note_localized(&entry.scan, pose, &done.counts, input.scan_count(), localizer);
        }
        true
    })?;
    progress.end();
    Ok(done)
}

/// Passes each scan of the log to `process`, until that returns false or the user stops the run.
fn for_each_scan(
    input: &mut LogInput,
    progress: &dyn StepProgress,
    done: &mut ProcessedLog,
    mut process: impl FnMut(&LogInput, &mut ProcessedLog, &LaserLogScan) -> bool,
) -> Result<(), AppError> {
    progress.begin(Some(input.scan_count()));
    let mut goes_on = true;
    while goes_on && !is_stopped(done.counts.read, input) {
        let Some(entry) = input.next_scan()?.map(Arc::new) else { break };
        done.odometry.push((entry.scan.stamp(), entry.odom_from_base));
        done.steps.take(&entry);
        goes_on = process(input, done, &entry);
        progress.advance();
    }
    done.counts.in_log = input.scan_count();
    Ok(())
}
