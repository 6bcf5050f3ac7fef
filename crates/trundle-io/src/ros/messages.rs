//! The ROS 2 message types that are read: laser scan, odometry and transforms.

use super::cdr::{CdrError, CdrReader};
use nalgebra::{Quaternion, UnitQuaternion};
use trundle_core::{Pose3, Stamp, Vector3};

/// The types of messages that are read.
pub(super) mod types {
    pub const LASER_SCAN: &str = "sensor_msgs/msg/LaserScan";
    pub const ODOMETRY: &str = "nav_msgs/msg/Odometry";
    pub const TF: &str = "tf2_msgs/msg/TFMessage";
}

/// `sensor_msgs/msg/LaserScan`, as far as it is used.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LaserScan {
    pub stamp: Stamp,
    pub frame: String,
    /// Of the first beam and between beams, about the laser's z, rad.
    pub angle_min: f64,
    pub angle_increment: f64,
    /// m.
    pub range_min: f64,
    pub range_max: f64,
    pub ranges: Vec<f32>,
}

/// `nav_msgs/msg/Odometry`, as far as it is used.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Odometry {
    pub stamp: Stamp,
    /// Whose pose it is.
    pub child: String,
    /// `odom_from_child`.
    pub pose: Pose3,
}

/// A `geometry_msgs/msg/TransformStamped` of a `tf2_msgs/msg/TFMessage`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Transform {
    pub stamp: Stamp,
    pub parent: String,
    pub child: String,
    pub parent_from_child: Pose3,
}

impl LaserScan {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::LASER_SCAN, bytes)?;
        let (stamp, frame) = header(&mut r)?;
        let angle_min = r.f32("angle_min")?;
        r.f32("angle_max")?;
        let angle_increment = r.f32("angle_increment")?;
        r.f32("time_increment")?;
        r.f32("scan_time")?;
        Ok(Self {
            stamp,
            frame,
            angle_min: f64::from(angle_min),
            angle_increment: f64::from(angle_increment),
            range_min: f64::from(r.f32("range_min")?),
            range_max: f64::from(r.f32("range_max")?),
            ranges: r.f32_list("ranges")?,
        })
    }
}

impl Odometry {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::ODOMETRY, bytes)?;
        let (stamp, _) = header(&mut r)?;
        let child = frame(&mut r, "child_frame_id")?;
        Ok(Self { stamp, child, pose: pose(&mut r, "pose")? })
    }
}

impl Transform {
    /// All of a message.
    pub(super) fn read_all(bytes: &[u8]) -> Result<Vec<Self>, CdrError> {
        let mut r = CdrReader::new(types::TF, bytes)?;
        // A transform is two times, two texts and seven numbers.
        let count = r.count("transforms", 72)?;
        (0..count).map(|_| Self::read(&mut r)).collect()
    }

    fn read(r: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let (stamp, parent) = header(r)?;
        let child = frame(r, "child_frame_id")?;
        Ok(Self { stamp, parent, child, parent_from_child: pose(r, "transform")? })
    }
}

/// `std_msgs/msg/Header`: stamp and frame.
fn header(r: &mut CdrReader<'_>) -> Result<(Stamp, String), CdrError> {
    let (seconds, nanos) = (r.i32("header.stamp.sec")?, r.u32("header.stamp.nanosec")?);
    let stamp = Stamp::from_nanos(i64::from(seconds) * 1_000_000_000 + i64::from(nanos));
    Ok((stamp, frame(r, "header.frame_id")?))
}

/// The name of a frame; a slash before it is of ROS 1's days.
fn frame(r: &mut CdrReader<'_>, field: &'static str) -> Result<String, CdrError> {
    let name = r.string(field)?;
    Ok(name.strip_prefix('/').map_or(name.clone(), str::to_owned))
}

/// Position and quaternion (x, y, z, w); what is no pose becomes one that is not finite.
fn pose(r: &mut CdrReader<'_>, field: &'static str) -> Result<Pose3, CdrError> {
    let [x, y, z, qx, qy, qz, qw] = r.f64s(field)?;
    let q = Quaternion::new(qw, qx, qy, qz);
    let rotation = UnitQuaternion::try_new(q, 1e-6);
    let place = Vector3::new(x, y, z);
    Ok(match rotation {
        Some(rotation) if q.norm() < 1e6 => Pose3::new(rotation, place),
        _ => Pose3::new(UnitQuaternion::identity(), Vector3::repeat(f64::NAN)),
    })
}
