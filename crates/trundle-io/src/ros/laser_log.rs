//! Conversion of a ROS bag into a laser log.

use super::contents::{BagMotion, Contents};
use super::frames::NoTransform;
use super::laser_scan::NoEcho;
use super::messages::LaserScan;
use crate::carmen::read_carmen;
use crate::laser_log::{
    LaserLog, LaserLogOptions, LaserLogScan, LaserLogSources, LaserMount, Motion, insert_in_order,
    require_order,
};
use crate::{Expected, IoError};
use std::path::Path;
use trundle_core::{Pose3, Vector3};

/// The scans and odometry of a CARMEN log, an MCAP file, a ROS 2 bag (its folder or a file of it) or a ROS 1 bag.
///
/// # Errors
/// As [`read_carmen`] and [`read_ros_bag`].
pub fn read_laser_log(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    match Expected::LaserLog.check(path)? {
        kind if kind.is_bag() => read_ros_bag(path, options),
        _ => read_carmen(path, options),
    }
}

/// The scans of a ROS 2 bag (MCAP or SQLite) or a ROS 1 bag, each with the odometry at its stamp, interpolated. The static transforms
/// give the mount of the laser. Times are those in the messages' headers.
///
/// Messages up to 0.05 s out of order are sorted. One that is broken, whose time goes back farther, or that no odometry is known for is
/// skipped and named in
/// [`LaserLog::skipped`], by its number in the bag.
///
/// # Errors
/// When the bag cannot be read or is truncated before its first scan, there is no scan or no odometry, no transform gives the mount of the
/// laser, or no scan can be used: then the first problem is named.
pub fn read_ros_bag(path: &Path, options: &LaserLogOptions) -> Result<LaserLog, IoError> {
    options.validate().map_err(IoError::field(path))?;
    let mut contents = Contents::read(path)?;
    let wrong = |problem: String| IoError::malformed(path, problem);
    let (topic, scans) = contents.scans(options.scan_topic.as_deref()).map_err(wrong)?;
    let motion = contents.motion(options.odometry_topic.as_deref()).map_err(wrong)?;
    let mut log = LaserLog::default();
    for (number, message) in &scans {
        let mount = mount(&contents, &topic, &motion.base, message, options).map_err(wrong)?;
        log.mount = turned(&mount);
        let taken = take(&mut log, message, &mount, &motion.motion, options.max_range);
        if log.bad_ranges > 0 {
            log.first_bad_range.get_or_insert(*number);
        }
        if let Err(problem) = taken {
            contents.skip(*number, &topic, &problem);
        }
    }
    finish(log, contents, &topic, &scans, motion).map_err(wrong)
}

/// The pose of the laser of a message, `base_from_laser`.
fn mount(
    contents: &Contents,
    topic: &str,
    base: &str,
    message: &LaserScan,
    options: &LaserLogOptions,
) -> Result<Pose3, String> {
    const WAY_OUT: &str = "say where the laser sits with --laser-x and --laser-turn";
    let frame = &message.frame;
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

/// Adds the data other than scans. A log without scans is refused.
fn finish(
    mut log: LaserLog,
    mut contents: Contents,
    topic: &str,
    scans: &[(usize, LaserScan)],
    motion: BagMotion,
) -> Result<LaserLog, String> {
    let times = scans.first().zip(scans.last()).map(|((_, a), (_, b))| (a.stamp, b.stamp));
    let other_clock = times.and_then(|times| motion.motion.other_clock(times));
    contents.skipped.sort_by_key(|skip| skip.line);
    log.sources =
        LaserLogSources { scans: topic.to_owned(), odometry: motion.topic, left: contents.topics_left() };
    log.skipped = contents.skipped;
    log.odometry = motion.motion.into_poses();
    match (log.scans.first(), log.skipped.first()) {
        (None, Some(first)) => {
            Err(format!("no scan can be used: {}", other_clock.as_ref().unwrap_or(&first.problem)))
        }
        (None, None) => Err(format!("no scan on {topic}")),
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
    require_order(log.scans.last().map(|scan| scan.scan.stamp()), message.stamp)?;
    let odom_from_base = motion.at(message.stamp)?;
    let converted = message.sweep().on_base(mount, max_range, NoEcho::Unseen)?;
    let scan = LaserLogScan { odom_from_base, scan: converted.scan };
    insert_in_order(&mut log.scans, scan, |scan| scan.scan.stamp())?;
    log.bad_ranges += converted.bad_ranges;
    log.max_range = Some(max_range.unwrap_or(message.range_max));
    Ok(())
}
