//! Conversion of a ROS 2 bag into a laser log.

use super::bag::{Bag, is_bag};
use super::frames::Frames;
use super::laser_scan::convert;
use super::messages::{LaserScan, Odometry, Transform, types};
use super::motion::Motion;
use crate::IoError;
use crate::carmen::{LaserLog, LaserLogOptions, LaserLogScan, LaserLogSkip, read_carmen};
use crate::recording::RawMessage;
use nalgebra::UnitQuaternion;
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Pose2, Pose3};

/// Which messages of a ROS 2 bag make the log, and what it does not say.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RosBagOptions {
    /// Where the laser sits, which way up, and from where on its ranges are no returns; by default what transforms and scans
    /// say.
    pub laser: LaserLogOptions,
    /// The topic of the scans; by default that with the most `sensor_msgs/msg/LaserScan`.
    pub scan_topic: Option<String>,
    /// The topic of the odometry; by default that with the most `nav_msgs/msg/Odometry`, else the transforms below `odom`.
    pub odometry_topic: Option<String>,
}

/// The scans and odometry of a CARMEN log, an MCAP file, or a ROS 2 bag: its folder or a file of it.
///
/// # Errors
/// As [`read_carmen`] and [`read_ros_bag`].
pub fn read_laser_log(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    if is_bag(path) {
        read_ros_bag(path, &RosBagOptions { laser: *options, ..RosBagOptions::default() })
    } else {
        read_carmen(path, options)
    }
}

/// The scans of a ROS 2 bag (MCAP or SQLite), each with the odometry of its moment, interpolated, the laser mounted as the
/// static transforms say. Times are those in the messages' headers.
///
/// A message that is broken, whose time goes back, or that no odometry is known for is skipped and named in
/// [`LaserLog::skipped`], by its number in the bag.
///
/// # Errors
/// When the bag cannot be read or breaks off before its first scan, there is no scan or no odometry, no transform says where
/// the laser sits, or no scan can be used: then the first problem is named.
pub fn read_ros_bag(path: &Path, options: &RosBagOptions) -> Result<LaserLog, IoError> {
    crate::carmen::validated(&options.laser).map_err(IoError::field(path))?;
    let mut contents = Contents::read(path, options)?;
    let wrong = |problem: String| IoError::malformed(path, problem);
    let (topic, scans) = contents.scans(options).map_err(wrong)?;
    let (base, motion) = contents.motion(options).map_err(wrong)?;
    let mut log = LaserLog::default();
    for (number, message) in scans {
        let taken = match contents.base_from_laser(&base, &message.frame, &options.laser) {
            None => {
                let (frame, known) = (&message.frame, contents.all.names());
                return Err(wrong(format!(
                    "no transform leads from {base} to {frame}, the frame of {topic} (transforms: {known}); where the laser \
                     sits must be given"
                )));
            }
            Some(mount) => take(&mut log, &message, &mount, &motion, options.laser.max_range),
        };
        if log.bad_ranges > 0 {
            log.first_bad_range.get_or_insert(number);
        }
        if let Err(problem) = taken {
            contents.skip(number, &topic, &problem);
        }
    }
    contents.skipped.sort_by_key(|skip| skip.line);
    log.skipped = contents.skipped;
    log.odometry = motion.into_poses();
    match (log.scans.first(), log.skipped.first()) {
        (None, Some(first)) => Err(wrong(format!("no scan can be used: {}", first.problem))),
        (None, None) => Err(wrong(format!("no scan on {topic}"))),
        _ => Ok(log),
    }
}

/// Adds a scan to the log.
fn take(
    log: &mut LaserLog,
    message: &LaserScan,
    mount: &Pose3,
    motion: &Motion,
    max_range: Option<f64>,
) -> Result<(), String> {
    if let Some(before) = log.scans.last().filter(|before| message.stamp < before.scan.stamp()) {
        return Err(format!("time goes back from {} s to {} s", before.scan.stamp(), message.stamp));
    }
    let odom_from_base = motion.at(message.stamp)?;
    let converted = convert(message, mount, max_range)?;
    log.bad_ranges += converted.bad_ranges;
    log.max_range = Some(max_range.unwrap_or(message.range_max));
    log.scans.push(LaserLogScan { odom_from_base, scan: converted.scan });
    Ok(())
}

/// All messages of a bag that say something to us, with their numbers in it, by topic.
#[derive(Default)]
struct Contents {
    scans: BTreeMap<String, Vec<(usize, LaserScan)>>,
    odometry: BTreeMap<String, Vec<(usize, Odometry)>>,
    moving: Vec<(usize, String, Transform)>,
    fixed: Frames,
    all: Frames,
    skipped: Vec<LaserLogSkip>,
}

impl Contents {
    fn read(path: &Path, options: &RosBagOptions) -> Result<Self, IoError> {
        let mut contents = Self::default();
        let mut bag = Bag::open(path)?;
        for number in 1.. {
            match bag.next_message() {
                Ok(Some(message)) => {
                    if let Err(problem) = contents.take(number, &message, options) {
                        contents.skip(number, &message.topic, &problem);
                    }
                }
                Ok(None) => break,
                // A recording that broke off is worth what it holds.
                Err(error) if !contents.scans.is_empty() => {
                    contents.skipped.push(LaserLogSkip { line: number, problem: error.to_string() });
                    break;
                }
                Err(error) => return Err(error),
            }
        }
        Ok(contents)
    }

    fn take(&mut self, number: usize, message: &RawMessage, options: &RosBagOptions) -> Result<(), String> {
        let RawMessage { topic, schema, data, .. } = message;
        let wanted = |asked: &Option<String>| asked.as_ref().is_none_or(|asked| asked == topic);
        match schema.as_str() {
            types::LASER_SCAN if wanted(&options.scan_topic) => {
                let scan = LaserScan::read(data).map_err(|error| error.to_string())?;
                self.scans.entry(topic.clone()).or_default().push((number, scan));
            }
            types::ODOMETRY if wanted(&options.odometry_topic) => {
                let odometry = Odometry::read(data).map_err(|error| error.to_string())?;
                self.odometry.entry(topic.clone()).or_default().push((number, odometry));
            }
            types::TF => {
                for transform in Transform::read_all(data).map_err(|error| error.to_string())? {
                    self.all.insert(transform.clone());
                    if topic.trim_start_matches('/').ends_with("tf_static") {
                        self.fixed.insert(transform);
                    } else {
                        self.moving.push((number, topic.clone(), transform));
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The topic of most scans, and these.
    fn scans(&mut self, options: &RosBagOptions) -> Result<(String, Vec<(usize, LaserScan)>), String> {
        most(&mut self.scans).ok_or_else(|| match (&options.scan_topic, self.skipped.first()) {
            (_, Some(skip)) => format!("no scan can be used: {}", skip.problem),
            (Some(topic), _) => format!("no {} on {topic}", types::LASER_SCAN),
            (None, None) => format!("no {} in it", types::LASER_SCAN),
        })
    }

    /// The name of the base's frame, and where it was by odometry.
    fn motion(&mut self, options: &RosBagOptions) -> Result<(String, Motion), String> {
        let poses: Vec<_> = match most(&mut self.odometry) {
            Some((topic, all)) => {
                all.into_iter().map(|(number, o)| (number, topic.clone(), o.stamp, o.child, o.pose)).collect()
            }
            None if options.odometry_topic.is_none() => self.odometry_by_transforms(),
            None => Vec::new(),
        };
        let base = poses.iter().map(|pose| pose.3.clone()).find(|base| !base.is_empty());
        let mut motion = Motion::default();
        for (number, topic, stamp, _, pose) in poses {
            let planar =
                if pose.is_finite() { pose.to_pose2() } else { Pose2 { x: f64::NAN, ..Pose2::IDENTITY } };
            if let Err(problem) = motion.push(stamp, planar) {
                self.skip(number, &topic, &problem);
            }
        }
        if motion.is_empty() {
            return Err(format!("no {} and no transform below odom in it", types::ODOMETRY));
        }
        Ok((base.unwrap_or_else(|| "base_link".to_owned()), motion))
    }

    fn odometry_by_transforms(&self) -> Vec<(usize, String, trundle_core::Stamp, String, Pose3)> {
        let below = self.moving.iter().filter(|(_, _, t)| t.parent.ends_with("odom"));
        let pose = |(number, topic, t): &(usize, String, Transform)| {
            (*number, topic.clone(), t.stamp, t.child.clone(), t.parent_from_child)
        };
        let poses: Vec<_> = below.map(pose).collect();
        let base = poses.first().map(|pose| pose.3.clone());
        poses.into_iter().filter(|pose| Some(&pose.3) == base.as_ref()).collect()
    }

    fn base_from_laser(&self, base: &str, laser: &str, options: &LaserLogOptions) -> Option<Pose3> {
        let told = self.fixed.between(base, laser).or_else(|| self.all.between(base, laser));
        let LaserLogOptions { laser_x, laser_turn, upside_down, .. } = *options;
        if laser_x.is_none() && laser_turn.is_none() {
            return told;
        }
        // Where no transform says anything, what was not given is zero.
        let roll = if upside_down { std::f64::consts::PI } else { 0.0 };
        let own = || Pose3::new(UnitQuaternion::from_euler_angles(roll, 0.0, 0.0), Default::default());
        let Pose3 { rotation, mut translation } = told.unwrap_or_else(own);
        translation.x = laser_x.unwrap_or(translation.x);
        let ahead = rotation * nalgebra::Vector3::x();
        let turn = laser_turn.map_or(0.0, |turn| turn - ahead.y.atan2(ahead.x));
        Some(Pose3::new(UnitQuaternion::from_euler_angles(0.0, 0.0, turn) * rotation, translation))
    }

    fn skip(&mut self, number: usize, topic: &str, problem: &str) {
        self.skipped
            .push(LaserLogSkip { line: number, problem: format!("message {number} on {topic}: {problem}") });
    }
}

/// The topic with the most messages, the first of equals.
fn most<T>(topics: &mut BTreeMap<String, Vec<T>>) -> Option<(String, Vec<T>)> {
    let most = topics.values().map(Vec::len).max()?;
    let topic = topics.iter().find(|(_, messages)| messages.len() == most)?.0.clone();
    let messages = topics.remove(&topic)?;
    Some((topic, messages))
}
