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
    /// Whether only the last minute is stored.
    is_brief: bool,
}

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
        Self { is_brief: true, ..Self::default() }
    }

    /// Whether the log keeps the last minute only.
    pub fn is_brief(&self) -> bool {
        self.is_brief
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
        if self.is_brief {
            self.drop_old();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brief_log_does_not_grow() {
        let mut log = RunLog::brief();
        for i in 0..20_000 {
            let stamp = Stamp::from_nanos(i * 20_000_000);
            log.on_event(&SensorEvent::Truth { stamp, pose: Pose2::IDENTITY }, Pose2::IDENTITY);
            let mut report = StepReport::default();
            report.twist = Some(Twist2::ZERO);
            log.on_report(stamp, &report);
        }
        for length in [log.truths.len(), log.twists.len()] {
            assert!((3000..=3001 + MIN_DROPPED_ENTRIES).contains(&length), "{length}");
        }
        assert!(log.truth_at(log.now).is_some());
    }
}
