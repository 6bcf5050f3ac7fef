//! The result of a mapped log.

use super::counts::ScanCounts;
use trundle_core::{Cell, OccupancyGrid};
use trundle_io::{LaserLog, empty_map_cause, no_overlap_cause, range_unit_hint};

/// Share of the scans without overlap with the map \[1\]. Above it the map shows no place. Source: ours; of the shared logs none has a
/// share above 0.01.
const MAX_SHARE_WITHOUT_OVERLAP: f64 = 0.5;

/// Share of the scans that pauses left out \[1\]. Above it the run missed its goal or a limit. Source: ours.
const MAX_SHARE_LEFT_OUT: f64 = 0.1;

/// Share of the scans of a log that must be usable \[1\]. Below it the run missed its goal: the map shows the smaller part of the drive.
/// Source: ours.
const MIN_SHARE_USED: f64 = 0.5;

/// The result of a log.
#[derive(Debug)]
pub struct LaserMapRun {
    /// Counts of the scans by their result.
    pub counts: ScanCounts,
    /// Memory of maps, scans and trajectories, MB.
    pub megabytes: f64,
    /// Wall-clock time, s.
    pub seconds: f64,
    /// Whether the user ended it before the last scan.
    pub is_interrupted: bool,
    /// Probable error of the laser's mount, where the scans contradict the odometry at many steps.
    pub mount_hint: Option<String>,
    /// Reason why the run missed its goal or a limit; `None` if it did not.
    pub failure: Option<String>,
}

impl LaserMapRun {
    /// Reason why a log that gave these counts and this map, if one was made, missed the aim, with the likely cause. `is_stopped`: whether
    /// the user ended the run.
    pub(super) fn failure_of(
        log: &LaserLog,
        counts: &ScanCounts,
        grid: Option<&OccupancyGrid>,
        is_stopped: bool,
    ) -> Option<String> {
        let is_in = |cell: Cell| grid.is_none_or(|grid| grid.cells().contains(&cell));
        if counts.processed == 0 {
            return Some(nothing_processed(log, counts, is_stopped));
        }
        if let Some(failure) =
            left_out(counts).or_else(|| of_one_time(log)).or_else(|| skipped(log, counts, is_stopped))
        {
            return Some(failure);
        }
        if counts.without_overlap as f64 > MAX_SHARE_WITHOUT_OVERLAP * counts.processed as f64 {
            let (without, all) = (counts.without_overlap, counts.processed);
            let cause = no_overlap_cause(log);
            return Some(format!("{without} of {all} scans do not overlap with the map: {cause}"));
        }
        let failure = if !is_in(Cell::Free) && !is_in(Cell::Occupied) {
            "the map has no known cell"
        } else if !is_in(Cell::Occupied) {
            "the map has no occupied cell"
        } else {
            return None;
        };
        Some(format!("{failure}: {}", empty_map_cause(log)))
    }

    /// Warnings about skipped entries, impossible ranges, another mount of the laser, and scans that pauses of mapping left out.
    #[must_use]
    pub fn warnings(&self, log: &LaserLog) -> Vec<String> {
        let warnings = log.warnings();
        let of_log = warnings.iter().map(|warning| warning.to_string());
        let of_pauses = self.pause_warning().filter(|_| self.failure.is_none());
        of_log.chain(self.mount_hint.clone()).chain(of_pauses).collect()
    }

    /// A warning about scans that pauses of mapping left out; `None` without a pause.
    fn pause_warning(&self) -> Option<String> {
        let counts = &self.counts;
        (counts.pauses > 0).then(|| format!("{} scans are left out: {}", counts.left_out, pause_note(counts)))
    }

    /// Wall-clock time of a processed scan, ms.
    #[must_use]
    pub fn scan_ms(&self) -> f64 {
        self.seconds * 1e3 / (self.counts.processed + self.counts.lost).max(1) as f64
    }
}

/// The failure of a log whose scans all have one timestamp, so that all have one pose.
fn of_one_time(log: &LaserLog) -> Option<String> {
    let (stamp, count) = (log.statistics.only_stamp()?, log.statistics.scans);
    Some(format!(
        "all {count} scans have the timestamp {stamp} s, expected one timestamp a scan: are the headers filled in?"
    ))
}

/// The failure of a log of which the smaller part of the scans could be used.
fn skipped(log: &LaserLog, counts: &ScanCounts, is_stopped: bool) -> Option<String> {
    let (used, all) = (counts.in_log, counts.in_log + log.skipped.len());
    let first = log.skipped.first()?;
    let is_rest = !is_stopped && (used as f64) < MIN_SHARE_USED * all as f64;
    is_rest.then(|| format!("only {used} of {all} scans could be used; {}", first.problem))
}

/// The failure of a run whose pauses left out much.
fn left_out(counts: &ScanCounts) -> Option<String> {
    let (out, all) = (counts.left_out, counts.left_out + counts.processed);
    (out as f64 > MAX_SHARE_LEFT_OUT * all as f64)
        .then(|| format!("{out} of {all} scans are left out: {}", pause_note(counts)))
}

/// A sentence about the pauses of mapping.
fn pause_note(counts: &ScanCounts) -> String {
    let since = counts.first_pause.map_or_else(String::new, |stamp| format!(", from {stamp} s on"));
    format!(
        "scans contradict the map to be extended{since}, and mapping paused until a place was recognised ({} pauses): was the robot carried, or is it the map of another place?",
        counts.pauses
    )
}

/// Reason why no scan was inserted into the map or localized in it.
fn nothing_processed(log: &LaserLog, counts: &ScanCounts, is_stopped: bool) -> String {
    let all = counts.in_log;
    if counts.lost > 0 {
        let cause = range_unit_hint(log).unwrap_or_else(|| {
            "is it the map of this place, with the laser mounted as in the log?".to_owned()
        });
        let end = if is_stopped { ", then the run was stopped" } else { "" };
        return format!(
            "no scan was found in the map: {} of {all} scans do not fit it{end}: {cause}",
            counts.lost
        );
    }
    if is_stopped {
        return format!(
            "no scan was put into the map or found in it: the run was stopped before the first of {all} scans"
        );
    }
    if counts.refused > 0 {
        return format!(
            "no scan was put into the map or found in it: {} of {all} scans were refused",
            counts.refused
        );
    }
    format!("no scan was put into the map or found in it: {}", empty_map_cause(log))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failure(counts: &ScanCounts, is_stopped: bool) -> Option<String> {
        LaserMapRun::failure_of(&LaserLog::default(), counts, None, is_stopped)
    }

    #[test]
    fn a_map_that_most_scans_do_not_overlap_with_is_a_missed_aim() {
        let counts = |without_overlap| ScanCounts { processed: 28, without_overlap, ..ScanCounts::default() };
        assert_eq!(failure(&counts(14), false), None);
        let missed = failure(&counts(27), false).unwrap();
        assert!(missed.starts_with("27 of 28 scans do not overlap with the map: "), "{missed}");
    }

    #[test]
    fn scans_that_do_not_fit_a_map_and_a_stop_are_named() {
        let lost = ScanCounts { lost: 60, ..ScanCounts::default() };
        let foreign = failure(&lost, false).unwrap();
        assert!(foreign.contains("60 of 0 scans do not fit it: is it the map of this place"), "{foreign}");
        let stopped = failure(&ScanCounts::default(), true).unwrap();
        assert!(stopped.contains("the run was stopped before the first"), "{stopped}");
        let refused = ScanCounts { refused: 3, ..ScanCounts::default() };
        assert!(failure(&refused, false).unwrap().contains("3 of 0 scans were refused"));
    }
}
