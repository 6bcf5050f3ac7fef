//! The scans of a bag's laser, for a robot.

use super::mount::BasePlace;
use crate::Warnings;
use crate::laser_log::{chosen, insert_in_order};
use crate::recording::RawMessage;
use crate::ros::cdr::{CdrError, Wire};
use crate::ros::laser_scan::NoEcho;
use crate::ros::messages::{LaserScan, types};
use std::collections::BTreeMap;
use trundle_core::{Pose3, Scan, Stamp};

/// A scan with the number of its message.
pub(in crate::ros) type NumberedScan = (usize, LaserScan);

/// The scans of a bag's lasers by topic, with the numbers of their messages.
#[derive(Default)]
pub(in crate::ros) struct ScanMessages {
    topics: BTreeMap<String, Vec<NumberedScan>>,
}

impl ScanMessages {
    pub(in crate::ros) fn take(
        &mut self,
        number: usize,
        message: &RawMessage,
        wire: Wire,
    ) -> Result<(), CdrError> {
        let scan = LaserScan::read(&message.data, wire)?;
        self.topics.entry(message.topic.clone()).or_default().push((number, scan));
        Ok(())
    }

    pub(in crate::ros) fn is_empty(&self) -> bool {
        self.topics.is_empty()
    }

    /// Takes the scans out, the topic with the largest number first; only those of the requested topic if there is one.
    ///
    /// # Errors
    /// When the requested topic does not exist.
    pub(in crate::ros) fn take_out(
        &mut self,
        asked: Option<&str>,
    ) -> Result<Vec<(String, Vec<NumberedScan>)>, String> {
        let counts = self.topics.iter().map(|(topic, scans)| (topic.clone(), scans.len())).collect();
        let asked = asked.map(|asked| chosen(&counts, Some(asked), types::LASER_SCAN)).transpose()?;
        let mut topics: Vec<_> = std::mem::take(&mut self.topics).into_iter().collect();
        topics.retain(|(topic, _)| asked.as_ref().is_none_or(|asked| asked == topic));
        topics.sort_by_key(|(_, scans)| std::cmp::Reverse(scans.len()));
        Ok(topics)
    }
}

/// The usable sweeps of a laser by rising stamps, as ranges of the messages.
#[derive(Default)]
pub(in crate::ros) struct RosScans {
    sweeps: Vec<Sweep>,
    /// `base_from_laser` of each frame.
    mounts: BTreeMap<String, Pose3>,
}

struct Sweep {
    message: LaserScan,
    /// Time of the last beam.
    end: Stamp,
}

impl RosScans {
    /// Times of the first and of the last beam of each scan, by rising stamps.
    pub(in crate::ros) fn times(&self) -> impl Iterator<Item = (Stamp, Stamp)> {
        self.sweeps.iter().map(|sweep| (sweep.message.stamp, sweep.end))
    }

    /// A scan, base frame.
    pub(in crate::ros) fn get(&self, index: usize) -> Option<Scan> {
        let message = &self.sweeps.get(index)?.message;
        scan_of(message, self.mounts.get(&message.frame)?).ok()
    }

    /// Takes the usable messages of a topic. Each kind of unusable messages gives a warning.
    fn of(topic: &str, messages: Vec<NumberedScan>, place: &BasePlace<'_>, warnings: &mut Warnings) -> Self {
        let mut scans = Self::default();
        for (number, message) in messages {
            let before = scans.sweeps.last().map(|sweep| sweep.message.ranges.len());
            let (count, at) = (message.ranges.len(), format!("message {number}"));
            if let Err(problem) = scans.add(message, place) {
                warnings.add(&format!("laser on {topic}: {problem}; the scan is left out"), &at);
            } else if let Some(before) = before.filter(|before| *before != count) {
                let problem = format!(
                    "laser on {topic}: the number of ranges changes from {before} to {count}, expected one number; all are used"
                );
                warnings.add(&problem, &at);
            }
        }
        scans
    }

    fn add(&mut self, message: LaserScan, place: &BasePlace<'_>) -> Result<(), String> {
        place.require_clock(message.stamp)?;
        let mount = match self.mounts.get(&message.frame) {
            Some(mount) => *mount,
            None => place.base_from(&message.frame)?,
        };
        let scan = scan_of(&message, &mount)?;
        self.mounts.insert(message.frame.clone(), mount);
        let end = scan.stamp().after(last_beam_s(&scan));
        insert_in_order(&mut self.sweeps, Sweep { message, end }, |sweep| sweep.message.stamp)
    }
}

/// The scan of a robot's laser, as a live robot has it.
fn scan_of(message: &LaserScan, base_from_laser: &Pose3) -> Result<Scan, String> {
    message.sweep().on_base(base_from_laser, None, NoEcho::Free).map(|converted| converted.scan)
}

/// Time of the last measured beam after the stamp \[s\].
fn last_beam_s(scan: &Scan) -> f64 {
    let last = scan.beams().len().saturating_sub(1);
    scan.beam_times().map_or(0.0, |times| times.of(0).max(times.of(last)).max(0.0))
}

/// The topic and the scans of the first of `topics` with a usable scan; `None` if there is none.
pub(in crate::ros) fn choose_scans(
    topics: Vec<(String, Vec<NumberedScan>)>,
    place: &BasePlace<'_>,
    warnings: &mut Warnings,
) -> Option<(String, RosScans)> {
    topics.into_iter().find_map(|(topic, messages)| {
        let scans = RosScans::of(&topic, messages, place, warnings);
        (!scans.sweeps.is_empty()).then_some((topic, scans))
    })
}
