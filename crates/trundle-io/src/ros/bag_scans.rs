//! The laser log of a ROS bag, one scan at a time.

use super::bag::Bag;
use super::contents::Contents;
use super::frames::NoTransform;
use super::laser_scan::NoEcho;
use super::messages::{LaserScan, types};
use crate::IoError;
use crate::laser_log::{
    LaserLog, LaserLogOptions, LaserLogScan, LaserLogSkip, LaserLogSources, LaserMount, OrderBuffer, pose_at,
};
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Pose3, Vector3};

/// The scans of a bag, read one at a time. The bag is read twice; the memory does not grow with the number of scans.
pub(crate) struct BagScans {
    bag: Bag,
    /// Number of messages read.
    number: usize,
    topic: String,
    /// base_from_laser by the laser's frame.
    mounts: BTreeMap<String, Pose3>,
    max_range: Option<f64>,
    waiting: OrderBuffer<LaserLogScan>,
    is_at_end: bool,
    /// The scan that proved the log usable.
    first: Option<LaserLogScan>,
    /// Number of scans that are not given out yet.
    left: usize,
}

impl BagScans {
    /// Opens a bag. Returns the data of the log that need no scans, and the reader of its scans.
    pub(crate) fn open(path: &Path, options: &LaserLogOptions) -> Result<(LaserLog, Self), IoError> {
        options.validate().map_err(IoError::field(path))?;
        let mut contents = Contents::read(path)?;
        let wrong = |problem: String| IoError::malformed(path, problem);
        let (topic, survey) = contents.scan_topic(options.scan_topic.as_deref()).map_err(wrong)?;
        let motion = contents.motion(options.odometry_topic.as_deref()).map_err(wrong)?;
        let mount =
            |frame: &String| Ok((frame.clone(), mount(&contents, &topic, &motion.base, frame, options)?));
        let mounts = survey.frames.iter().map(mount).collect::<Result<_, String>>().map_err(wrong)?;
        let other_clock = survey.times.and_then(|times| motion.motion.other_clock(times));
        let mut log = LaserLog {
            sources: LaserLogSources {
                scans: topic.clone(),
                odometry: motion.topic,
                left: contents.topics_left(),
            },
            odometry: motion.motion.into_poses(),
            skipped: contents.skipped,
            ..LaserLog::default()
        };
        let mut scans = Self {
            bag: Bag::open(path)?,
            number: 0,
            topic,
            mounts,
            max_range: options.max_range,
            waiting: OrderBuffer::default(),
            is_at_end: false,
            first: None,
            left: survey.count,
        };
        scans.first = scans.next_scan(&mut log);
        if scans.first.is_some() {
            return Ok((log, scans));
        }
        Err(wrong(match log.skipped.first() {
            Some(skip) => format!("no scan can be used: {}", other_clock.as_ref().unwrap_or(&skip.problem)),
            None => format!("no scan on {}", scans.topic),
        }))
    }

    /// Number of scans that are not given out yet.
    pub(crate) fn left(&self) -> usize {
        self.left
    }

    /// The next scan, by rising stamps; `None` after the last one. Counts the scan, or what is skipped, in `log`.
    pub(crate) fn next_scan(&mut self, log: &mut LaserLog) -> Option<LaserLogScan> {
        if let Some(first) = self.first.take() {
            return Some(first);
        }
        loop {
            let next = if self.is_at_end { self.waiting.pop_last() } else { self.waiting.pop() };
            if let Some((_, scan)) = next {
                self.left = self.left.saturating_sub(1);
                log.statistics.count(&scan);
                return Some(scan);
            }
            if self.is_at_end {
                log.skipped.sort_by_key(|skip| skip.line);
                return None;
            }
            self.read_message(log);
        }
    }

    fn read_message(&mut self, log: &mut LaserLog) {
        // The survey has named messages that cannot be read, and the place where the bag breaks off.
        let Ok(Some(message)) = self.bag.next_message() else {
            self.is_at_end = true;
            return;
        };
        self.number += 1;
        if message.topic == self.topic
            && types::canonical(&message.schema) == types::LASER_SCAN
            && let Ok(scan) = LaserScan::read(&message.data, self.bag.wire())
            && let Err(problem) = self.take(&scan, log)
        {
            let problem = format!("message {} on {}: {problem}", self.number, self.topic);
            log.skipped.push(LaserLogSkip { line: self.number, problem });
            self.left = self.left.saturating_sub(1);
        }
    }

    /// Converts a scan, which then waits for its order.
    fn take(&mut self, message: &LaserScan, log: &mut LaserLog) -> Result<(), String> {
        let mount = self.mounts.get(&message.frame).ok_or("its frame is new")?;
        log.mount = turned(mount);
        self.waiting.require(message.stamp)?;
        let odom_from_base = pose_at(&log.odometry, message.stamp)?;
        let converted = message.sweep().on_base(mount, self.max_range, NoEcho::Unseen)?;
        self.waiting.push(message.stamp, LaserLogScan { odom_from_base, scan: converted.scan })?;
        log.bad_ranges += converted.bad_ranges;
        if log.bad_ranges > 0 {
            log.first_bad_range.get_or_insert(self.number);
        }
        log.max_range = Some(self.max_range.unwrap_or(message.range_max));
        Ok(())
    }
}

impl std::fmt::Debug for BagScans {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { topic, number, .. } = self;
        f.debug_struct("BagScans").field("topic", topic).field("number", number).finish_non_exhaustive()
    }
}

/// The pose of the laser with this frame, `base_from_laser`.
fn mount(
    contents: &Contents,
    topic: &str,
    base: &str,
    frame: &str,
    options: &LaserLogOptions,
) -> Result<Pose3, String> {
    const WAY_OUT: &str = "say where the laser sits with --laser-x and --laser-turn";
    contents.base_from_laser(base, frame, options).map_err(|missing| match missing {
        NoTransform::Broken(problem) => format!("{problem}, and {frame} is the frame of {topic}; {WAY_OUT}"),
        NoTransform::Unconnected => format!(
            "no transform leads from {base} to {frame}, the frame of {topic} (transforms: {}); {WAY_OUT}",
            contents.transform_names()
        ),
    })
}

/// The rotation of a laser at this pose.
fn turned(base_from_laser: &Pose3) -> LaserMount {
    let ahead = base_from_laser.rotate(Vector3::x());
    let up = base_from_laser.rotate(Vector3::z());
    LaserMount { turn: ahead.y.atan2(ahead.x), upside_down: up.z < 0.0 }
}
