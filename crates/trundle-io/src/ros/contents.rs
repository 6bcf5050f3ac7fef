//! The messages of a bag that make a laser log, by topic.

use super::bag::Bag;
use super::cdr::Wire;
use super::frames::{Frames, NoTransform};
use super::hidden_topics::is_hidden;
use super::messages::{LaserScan, MessagePose, Odometry, Transform, types};
use super::scan_survey::ScanSurvey;
use crate::IoError;
use crate::laser_log::{LaserLogOptions, LaserLogSkip, Motion, chosen, is_named};
use crate::recording::RawMessage;
use nalgebra::UnitQuaternion;
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Pose3, Stamp};

/// Maximum number of topics named in a message; further topics are counted. Source: ours.
const MAX_TOPICS_NAMED: usize = 20;

/// All usable messages of a bag, by topic, with their indices in the bag. Scans are surveyed only.
#[derive(Default)]
pub(in crate::ros) struct Contents {
    scans: BTreeMap<String, ScanSurvey>,
    odometry: BTreeMap<String, Vec<(usize, Odometry)>>,
    moving: Vec<(usize, String, Transform)>,
    fixed: Frames,
    all: Frames,
    pub(in crate::ros) skipped: Vec<LaserLogSkip>,
    /// All topics with the type and the number of their messages.
    topics: BTreeMap<String, (String, usize)>,
}

/// A pose of the base by odometry, with its message's number.
struct OdometryPose {
    number: usize,
    stamp: Stamp,
    child: String,
    pose: MessagePose,
}

/// The odometry of a bag.
pub(in crate::ros) struct BagMotion {
    pub(in crate::ros) topic: String,
    /// The name of the base's frame.
    pub(in crate::ros) base: String,
    pub(in crate::ros) motion: Motion,
}

impl Contents {
    pub(in crate::ros) fn read(path: &Path) -> Result<Self, IoError> {
        let mut contents = Self::default();
        let mut bag = Bag::open(path)?;
        for number in 1.. {
            match bag.next_message() {
                Ok(Some(message)) => {
                    if let Err(problem) = contents.take(number, &message, bag.wire()) {
                        contents.skip(number, &message.topic, &problem);
                    }
                }
                Ok(None) => break,
                // A recording that breaks off is used up to the break.
                Err(error) if !contents.scans.is_empty() => {
                    contents.skipped.push(LaserLogSkip { line: number, problem: error.to_string() });
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        if let (true, Some(cut)) = (contents.scans.is_empty(), bag.cuts.first()) {
            return Err(IoError::malformed(path, format!("{cut}, before its first scan")));
        }
        let line = contents.message_count();
        let problems = bag.cuts.into_iter().chain(bag.skipped);
        contents.skipped.extend(problems.map(|problem| LaserLogSkip { line, problem }));
        Ok(contents)
    }

    /// Number of messages read.
    fn message_count(&self) -> usize {
        self.topics.values().map(|(_, count)| count).sum()
    }

    pub(in crate::ros) fn take(
        &mut self,
        number: usize,
        message: &RawMessage,
        wire: Wire,
    ) -> Result<(), String> {
        let RawMessage { topic, schema, data, .. } = message;
        self.topics.entry(topic.clone()).or_insert_with(|| (schema.clone(), 0)).1 += 1;
        match types::canonical(schema) {
            types::LASER_SCAN => {
                let scan = LaserScan::read(data, wire).map_err(|error| error.to_string())?;
                self.scans.entry(topic.clone()).or_default().take(scan);
            }
            types::ODOMETRY => {
                let odometry = Odometry::read(data, wire).map_err(|error| error.to_string())?;
                self.odometry.entry(topic.clone()).or_default().push((number, odometry));
            }
            types::TF => {
                for transform in Transform::read_all(data, wire).map_err(|error| error.to_string())? {
                    self.take_transform(number, topic, transform);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn take_transform(&mut self, number: usize, topic: &str, transform: Transform) {
        self.all.insert(transform.clone());
        if topic.trim_start_matches('/').ends_with("tf_static") {
            self.fixed.insert(transform);
        } else {
            self.moving.push((number, topic.to_owned(), transform));
        }
    }

    /// The requested topic of scans, or the one with the most scans; and what its scans show.
    pub(in crate::ros) fn scan_topic(&mut self, asked: Option<&str>) -> Result<(String, ScanSurvey), String> {
        let topic = chosen(&self.scan_counts(), asked, types::LASER_SCAN);
        let topic = topic.map_err(|problem| match self.skipped.first() {
            Some(skip) if self.scans.is_empty() => format!("no scan can be used: {}", skip.problem),
            _ if self.scans.is_empty() => {
                format!("{problem}, expected one; its topics: {}", self.topic_names())
            }
            _ => problem,
        })?;
        let survey = self.scans.remove(&topic).unwrap_or_default();
        Ok((topic, survey))
    }

    /// The topics of scans that are still here, with the number of their messages.
    fn scan_counts(&self) -> BTreeMap<String, usize> {
        self.scans.iter().map(|(topic, survey)| (topic.clone(), survey.count)).collect()
    }

    /// Whether the bag has odometry, or transforms below `odom`.
    pub(in crate::ros) fn has_motion(&self) -> bool {
        !self.odometry.is_empty() || self.moving.iter().any(|(_, _, t)| t.parent.ends_with("odom"))
    }

    /// `to_from_from` by the static transforms, else by all.
    pub(in crate::ros) fn transform(&self, to: &str, from: &str) -> Result<Pose3, NoTransform> {
        self.fixed.between(to, from).or_else(|_| self.all.between(to, from))
    }

    /// The base's motion by the requested topic, or by the topic with the most odometry, or by transforms.
    pub(in crate::ros) fn motion(&mut self, asked: Option<&str>) -> Result<BagMotion, String> {
        let (topic, poses) = self.odometry_poses(asked)?;
        let base = poses.iter().map(|pose| pose.child.clone()).find(|base| !base.is_empty());
        let base = base.unwrap_or_else(|| "base_link".to_owned());
        let (mut motion, count, mut first) = (Motion::default(), poses.len(), None);
        for OdometryPose { number, stamp, pose, .. } in poses {
            let pushed = pose.and_then(|pose| motion.push(stamp, pose.to_pose2()));
            if let Err(problem) = pushed {
                self.skip(number, &topic, &problem);
                first.get_or_insert(problem);
            }
        }
        match first {
            Some(problem) if motion.is_empty() => {
                Err(format!("none of the {count} poses on {topic} can be used: {problem}"))
            }
            _ if motion.is_empty() => Err(format!(
                "no {} and no transform below odom in it, expected one of both; its topics: {}",
                types::ODOMETRY,
                self.topic_names()
            )),
            _ => Ok(BagMotion { topic, base, motion }),
        }
    }

    fn odometry_poses(&mut self, asked: Option<&str>) -> Result<(String, Vec<OdometryPose>), String> {
        let transforms = self.moving.iter().map(|(_, topic, _)| topic);
        let transforms = transforms.clone().find(|topic| match asked {
            Some(asked) => is_named(topic, asked),
            None => self.odometry.is_empty(),
        });
        if let Some(topic) = transforms.cloned() {
            return Ok((topic.clone(), self.odometry_by_transforms(&topic)));
        }
        if asked.is_none() && self.odometry.is_empty() {
            return Ok(("/tf".to_owned(), Vec::new()));
        }
        let topic = chosen(&counts(&self.odometry), asked, types::ODOMETRY)?;
        let all = self.odometry.remove(&topic).unwrap_or_default().into_iter();
        let pose = |(number, Odometry { stamp, child, pose })| OdometryPose { number, stamp, child, pose };
        Ok((topic, all.map(pose).collect()))
    }

    /// The poses of the base below `odom`.
    fn odometry_by_transforms(&self, topic: &str) -> Vec<OdometryPose> {
        let below = self.moving.iter().filter(|(_, from, t)| from == topic && t.parent.ends_with("odom"));
        let pose = |(number, _, t): &(usize, String, Transform)| OdometryPose {
            number: *number,
            stamp: t.stamp,
            child: t.child.clone(),
            pose: t.parent_from_child.clone(),
        };
        let poses: Vec<_> = below.map(pose).collect();
        let base = poses.first().map(|pose| pose.child.clone());
        poses.into_iter().filter(|pose| Some(&pose.child) == base.as_ref()).collect()
    }

    /// Mount of the laser from the options; missing values come from the transforms.
    pub(in crate::ros) fn base_from_laser(
        &self,
        base: &str,
        laser: &str,
        options: &LaserLogOptions,
    ) -> Result<Pose3, NoTransform> {
        let LaserLogOptions { laser_x, laser_turn, upside_down, .. } = *options;
        let recorded = self.transform(base, laser);
        let recorded = recorded.map(|pose| if upside_down { upside_down_at(pose) } else { pose });
        if laser_x.is_none() && laser_turn.is_none() {
            return recorded;
        }
        // Without a transform, missing values are zero.
        let roll = if upside_down { std::f64::consts::PI } else { 0.0 };
        let own = |_| Pose3::new(UnitQuaternion::from_euler_angles(roll, 0.0, 0.0), Default::default());
        let Pose3 { rotation, mut translation } = recorded.unwrap_or_else(own);
        translation.x = laser_x.unwrap_or(translation.x);
        let ahead = rotation * nalgebra::Vector3::x();
        let turn = laser_turn.map_or(0.0, |turn| turn - ahead.y.atan2(ahead.x));
        Ok(Pose3::new(UnitQuaternion::from_euler_angles(0.0, 0.0, turn) * rotation, translation))
    }

    /// The names of all transforms, for messages.
    pub(in crate::ros) fn transform_names(&self) -> String {
        self.all.names()
    }

    /// All topics with the type and the number of their messages, for messages.
    fn topic_names(&self) -> String {
        let name = |(topic, (kind, count)): (&String, &(String, usize))| {
            format!("{topic} ({kind}, {count} messages)")
        };
        let shown =
            || self.topics.iter().filter(|(topic, (kind, _))| !is_hidden(topic, types::canonical(kind)));
        let mut names: Vec<String> = shown().map(name).take(MAX_TOPICS_NAMED).collect();
        if shown().count() > MAX_TOPICS_NAMED {
            names.push(format!("{} more", shown().count() - MAX_TOPICS_NAMED));
        }
        if names.is_empty() { "none with messages in CDR".to_owned() } else { names.join(", ") }
    }

    /// The topics of scans and odometry that are still here, with the number of their messages.
    pub(in crate::ros) fn topics_left(&self) -> Vec<(String, usize)> {
        self.scan_counts().into_iter().chain(counts(&self.odometry)).collect()
    }

    pub(in crate::ros) fn skip(&mut self, number: usize, topic: &str, problem: &str) {
        let problem = format!("message {number} on {topic}: {problem}");
        self.skipped.push(LaserLogSkip { line: number, problem });
    }
}

/// The pose rotated around the laser's x axis, with its z axis down.
fn upside_down_at(pose: Pose3) -> Pose3 {
    if pose.rotate(nalgebra::Vector3::z()).z < 0.0 {
        return pose;
    }
    let roll = UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
    Pose3::new(pose.rotation * roll, pose.translation)
}

fn counts<T>(topics: &BTreeMap<String, Vec<T>>) -> BTreeMap<String, usize> {
    topics.iter().map(|(topic, messages)| (topic.clone(), messages.len())).collect()
}
