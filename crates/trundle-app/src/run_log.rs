//! The log of a run for evaluation and pictures: poses, truth, commands, states.

use crate::{BodyLog, PoseSample};
use serde::{Deserialize, Serialize};
use trundle_core::{Pose2, PoseEstimate, SensorEvent, Stamp, Twist2};
use trundle_runtime::{DriveState, Reason, StepReport, TransitionReason};
use trundle_slam::Tracking;

/// The log of a run for evaluation and pictures. All content comes from the data, none from the wall clock.
#[derive(Debug, Default)]
pub struct RunLog {
    /// First stamp of the run.
    pub start: Option<Stamp>,
    /// Newest stamp of the run.
    pub now: Stamp,
    /// `map_from_base` as estimated, at every image; without images at every matched scan.
    pub estimates: Vec<PoseEstimate>,
    /// `map_from_base` in truth, at every truth event.
    pub truths: Vec<(Stamp, Pose2)>,
    /// Commands by time.
    pub twists: Vec<(Stamp, Twist2)>,
    /// Number of bumper presses.
    pub presses: usize,
    /// Number of true contacts; `None` if unknown.
    pub true_contacts: Option<u32>,
    /// Plans made.
    pub plans: usize,
    /// Images by tracking state.
    pub tracked: TrackCounts,
    /// Scans that were matched to the map.
    pub scans_matched: usize,
    /// Time during which the pose was unknown, or too uncertain to drive \[s\].
    pub pose_lost_s: f64,
    /// Power, wheel drops, losses of devices.
    pub body: BodyLog,
    /// The newest state.
    pub state: DriveState,
    /// Each change of the state, or of the kind of its reason, as in the program's log.
    pub changes: Vec<StateChange>,
    extent: Extent,
}

/// Entries of a log that are kept.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Extent {
    /// All.
    #[default]
    Whole,
    /// Those of the last minutes, and of the time before one per second.
    Thinned,
    /// Those of the last minute.
    LastMinute,
}

/// Length of the whole part of a thinned log \[s\]. Source: ours; the time line of the live page has the same length.
const WHOLE_PART_S: f64 = 600.0;
/// Time between two entries of the thinned part \[s\]: poses, truth and commands of an hour have 0.6 MB. Source: ours.
const THINNED_PERIOD_S: f64 = 1.0;

/// Length of a brief log \[s\]. Older entries are dropped. Source: ours.
const BRIEF_LOG_S: f64 = 60.0;
/// Minimum number of old entries that are dropped in one step. Fewer old entries remain in the list, because each drop moves the list.
/// Source: ours.
const MIN_DROPPED_ENTRIES: usize = 1000;

/// A change of the robot's state, or of its reason.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StateChange {
    /// Seconds since the first event.
    pub at: f64,
    /// The new state.
    pub state: DriveState,
    /// Reason for the change; files of earlier versions hold none.
    #[serde(default)]
    pub transition: Option<TransitionReason>,
    /// The estimated pose, map frame.
    pub pose: Pose2,
}

/// Images by the tracking state.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrackCounts {
    /// Well tracked.
    pub ok: usize,
    /// Tracked on few features.
    pub weak: usize,
    /// Carried on by wheels and gyro, or by constant velocity.
    pub dead_reckoned: usize,
    /// Number of images without a pose.
    pub lost: usize,
}

impl TrackCounts {
    /// Number of images.
    #[must_use]
    pub fn total(&self) -> usize {
        self.ok + self.weak + self.dead_reckoned + self.lost
    }

    /// Counts one image.
    pub fn count(&mut self, tracking: Tracking) {
        match tracking {
            Tracking::Ok => self.ok += 1,
            Tracking::Weak => self.weak += 1,
            Tracking::DeadReckoning => self.dead_reckoned += 1,
            Tracking::Lost => self.lost += 1,
        }
    }
}

impl RunLog {
    /// Whether the user ended the run.
    pub fn is_interrupted(&self) -> bool {
        self.state == DriveState::Stopped { reason: Reason::Interrupted }
    }

    /// A log that keeps the last minute of poses, commands and states only: it does not grow in a run of hours.
    pub fn brief() -> Self {
        Self { extent: Extent::LastMinute, ..Self::default() }
    }

    /// The log of a run. A robot without a mission has a brief one; one that waits for goals after its mission (`is_operated`) has a thinned
    /// one, since its run may last for days; else the log is whole.
    pub fn of_run(has_mission: bool, is_operated: bool) -> Self {
        let extent = match (has_mission, is_operated) {
            (false, _) => Extent::LastMinute,
            (true, true) => Extent::Thinned,
            (true, false) => Extent::Whole,
        };
        Self { extent, ..Self::default() }
    }

    /// Whether the log keeps the last minute only.
    pub fn is_brief(&self) -> bool {
        self.extent == Extent::LastMinute
    }

    /// Thins entries that are too old for the whole part of a thinned log.
    fn thin_old(&mut self) {
        let now = self.now;
        thin_first(&mut self.estimates, now, |estimate| estimate.stamp);
        thin_first(&mut self.truths, now, |(stamp, _)| *stamp);
        thin_first(&mut self.twists, now, |(stamp, _)| *stamp);
    }

    /// Drops entries that are too old for a brief log.
    fn drop_old(&mut self) {
        let (now, end) = (self.now, self.elapsed());
        let is_old = |stamp: &Stamp| now - *stamp > BRIEF_LOG_S;
        drop_first(&mut self.estimates, |estimate| is_old(&estimate.stamp));
        drop_first(&mut self.truths, |(stamp, _)| is_old(stamp));
        drop_first(&mut self.twists, |(stamp, _)| is_old(stamp));
        drop_first(&mut self.changes, |change| end - change.at > BRIEF_LOG_S);
    }

    /// Logs the report of a step.
    pub fn on_report(&mut self, now: Stamp, report: &StepReport) {
        self.start.get_or_insert(now);
        if report.pose_is_lost {
            self.pose_lost_s += now - self.now.max(self.start.unwrap_or(now));
        }
        self.now = now;
        if let Some(estimate) = &report.estimate
            && self.changes.last().is_none_or(|last| is_change(&last.state, &report.state))
        {
            let (at, state, pose) = (self.elapsed(), report.state.clone(), estimate.pose);
            self.changes.push(StateChange { at, state, transition: report.transition, pose });
        }
        self.state = report.state.clone();
        self.plans += usize::from(report.replanned);
        self.scans_matched += usize::from(report.measurements.scan.is_some());
        if let Some(track) = &report.track {
            self.tracked.count(track.tracking);
            self.estimates.extend(report.estimate);
        } else if report.measurements.scan.is_some() && self.tracked == TrackCounts::default() {
            self.estimates.extend(report.estimate);
        }
        self.twists.extend(report.twist.map(|twist| (now, twist)));
        match self.extent {
            Extent::Whole => {}
            Extent::Thinned => self.thin_old(),
            Extent::LastMinute => self.drop_old(),
        }
    }

    /// Seconds since the first event.
    pub fn elapsed(&self) -> f64 {
        self.start.map_or(0.0, |start| self.now - start)
    }

    /// Stamps as seconds since the first event.
    pub fn seconds_of(&self, stamps: &[Stamp]) -> Vec<f64> {
        stamps.iter().map(|stamp| self.start.map_or(0.0, |start| *stamp - start)).collect()
    }

    /// Length of the true path, or of the estimated path without truth \[m\].
    pub fn path_length(&self) -> f64 {
        let path = if self.truths.is_empty() { &self.estimated_path() } else { &self.truths };
        path.windows(2).map(|pair| pair[1].1.distance(&pair[0].1)).sum()
    }

    /// Truth at the newest truth event up to `stamp`, map frame.
    pub fn truth_at(&self, stamp: Stamp) -> Option<Pose2> {
        let after = self.truths.partition_point(|(at, _)| *at <= stamp);
        self.truths.get(after.checked_sub(1)?).map(|(_, pose)| *pose)
    }

    /// The estimated poses, at every image; without images at every matched scan.
    pub fn estimated_path(&self) -> Vec<(Stamp, Pose2)> {
        self.estimates.iter().map(|estimate| (estimate.stamp, estimate.pose)).collect()
    }

    /// The estimate beside the truth, for every estimated pose with truth.
    pub fn pose_samples(&self) -> Vec<PoseSample> {
        let start = self.start.unwrap_or_default();
        let sample = |estimate: &PoseEstimate| {
            let truth = self.truth_at(estimate.stamp)?;
            Some(PoseSample::new(estimate.stamp - start, estimate, truth))
        };
        self.estimates.iter().filter_map(sample).collect()
    }

    /// Distance of the estimate from truth: root of the mean square, m.
    pub fn estimate_rmse(&self) -> Option<f64> {
        let samples = self.pose_samples();
        let sum: f64 = samples.iter().map(|sample| sample.distance().powi(2)).sum();
        (!samples.is_empty()).then(|| (sum / samples.len() as f64).sqrt())
    }

    /// Contacts: in truth if it is known, else the bumper's presses.
    pub fn contacts(&self) -> usize {
        self.true_contacts.map_or(self.presses, |count| count as usize)
    }

    /// Logs truth (moved into the map frame), bumper presses and events of the body, for evaluation only.
    pub fn on_event(&mut self, event: &SensorEvent, map_from_world: Pose2) {
        match event {
            SensorEvent::Truth { stamp, pose } => self.truths.push((*stamp, map_from_world * *pose)),
            SensorEvent::Touch(touch) => self.presses += usize::from(touch.pressed),
            SensorEvent::Body(event) => self.body.on_event(event.kind),
            _ => {}
        }
    }
}

/// Whether the state or the kind of its reason differs.
fn is_change(last: &DriveState, new: &DriveState) -> bool {
    let kind = |state: &DriveState| state.reason().map(Reason::kind);
    last.name() != new.name() || kind(last) != kind(new)
}

/// Drops the old entries from the front of a list sorted by time, many in one step.
fn drop_first<T>(list: &mut Vec<T>, is_old: impl Fn(&T) -> bool) {
    if list.get(MIN_DROPPED_ENTRIES).is_some_and(&is_old) {
        list.drain(..list.partition_point(is_old));
    }
}

/// Keeps one entry per [`THINNED_PERIOD_S`] of those older than [`WHOLE_PART_S`], in a list sorted by time; many in one step.
fn thin_first<T>(list: &mut Vec<T>, now: Stamp, stamp: impl Fn(&T) -> Stamp) {
    let is_old = |entry: &T| now - stamp(entry) > WHOLE_PART_S;
    // The thinned part has one entry per second. The rest of the old entries waits to be thinned.
    let thinned = list.first().map_or(0.0, |first| (now - stamp(first) - WHOLE_PART_S) / THINNED_PERIOD_S);
    let due = thinned.max(0.0) as usize + MIN_DROPPED_ENTRIES;
    if !list.get(due).is_some_and(&is_old) {
        return;
    }
    let mut last: Option<Stamp> = None;
    list.retain(|entry| {
        let at = stamp(entry);
        let is_kept = now - at <= WHOLE_PART_S || last.is_none_or(|last| at - last >= THINNED_PERIOD_S);
        if is_kept {
            last = Some(at);
        }
        is_kept
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A log after a run of `seconds` with truth and commands at 50 Hz.
    fn log_of(mut log: RunLog, seconds: i64) -> RunLog {
        for i in 0..50 * seconds {
            let stamp = Stamp::from_nanos(i * 20_000_000);
            let pose = Pose2::new(0.01 * i as f64, 0.0, 0.0);
            log.on_event(&SensorEvent::Truth { stamp, pose }, Pose2::IDENTITY);
            let mut report = StepReport::default();
            report.twist = Some(Twist2::ZERO);
            log.on_report(stamp, &report);
        }
        log
    }

    #[test]
    fn a_thinned_log_keeps_ten_minutes_whole_and_a_second_of_the_rest() {
        let thinned = RunLog { extent: Extent::Thinned, ..RunLog::default() };
        let log = log_of(thinned, 3600);
        let whole = (WHOLE_PART_S / 0.02) as usize;
        for length in [log.truths.len(), log.twists.len()] {
            assert!((whole + 2900..whole + 3100 + MIN_DROPPED_ENTRIES).contains(&length), "{length}");
        }
        assert!(log.truths.windows(2).all(|pair| pair[1].0 - pair[0].0 <= THINNED_PERIOD_S + 0.03));
        assert!((log.path_length() - 0.01 * 179_999.0).abs() < 1e-6, "{}", log.path_length());
    }

    #[test]
    fn the_log_follows_mission_and_operator() {
        assert_eq!(RunLog::of_run(true, false).extent, Extent::Whole);
        assert_eq!(RunLog::of_run(true, true).extent, Extent::Thinned);
        assert_eq!(RunLog::of_run(false, true).extent, Extent::LastMinute);
    }

    #[test]
    fn a_brief_log_does_not_grow() {
        let log = log_of(RunLog::brief(), 400);
        for length in [log.truths.len(), log.twists.len()] {
            assert!((3000..=3001 + MIN_DROPPED_ENTRIES).contains(&length), "{length}");
        }
        assert!(log.truth_at(log.now).is_some());
    }
}
