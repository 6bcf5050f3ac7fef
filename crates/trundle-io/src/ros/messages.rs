//! The ROS message types that are read: laser scan, odometry and transforms.

use super::cdr::{CdrError, CdrReader, Wire};
use super::laser_scan::LaserSweep;
use nalgebra::{Quaternion, UnitQuaternion};
use trundle_core::{Pose3, Stamp, Vector3};

/// The types of messages that are read.
pub(in crate::ros) mod types {
    pub const LASER_SCAN: &str = "sensor_msgs/msg/LaserScan";
    pub const ODOMETRY: &str = "nav_msgs/msg/Odometry";
    pub const IMU: &str = "sensor_msgs/msg/Imu";
    pub const TF: &str = "tf2_msgs/msg/TFMessage";
    pub const IMAGE: &str = "sensor_msgs/msg/Image";
    pub const COMPRESSED_IMAGE: &str = "sensor_msgs/msg/CompressedImage";
    pub const CAMERA_INFO: &str = "sensor_msgs/msg/CameraInfo";
    pub const TRANSFORM: &str = "geometry_msgs/msg/TransformStamped";

    /// Whether a type, by its name in ROS 2, is one of those that are read.
    pub fn is_sensor(kind: &str) -> bool {
        [LASER_SCAN, ODOMETRY, IMU, TF, IMAGE, COMPRESSED_IMAGE, CAMERA_INFO, TRANSFORM].contains(&kind)
    }

    /// The name in ROS 2 of a type of either ROS.
    pub fn canonical(name: &str) -> &str {
        match name {
            "sensor_msgs/LaserScan" => LASER_SCAN,
            "nav_msgs/Odometry" => ODOMETRY,
            "sensor_msgs/Imu" => IMU,
            "tf2_msgs/TFMessage" | "tf/tfMessage" => TF,
            "sensor_msgs/Image" => IMAGE,
            "sensor_msgs/CompressedImage" => COMPRESSED_IMAGE,
            "sensor_msgs/CameraInfo" => CAMERA_INFO,
            "geometry_msgs/TransformStamped" => TRANSFORM,
            other => other,
        }
    }
}

/// The used fields of `sensor_msgs/msg/LaserScan`.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ros) struct LaserScan {
    pub stamp: Stamp,
    pub frame: String,
    /// Angle of the first beam about the laser's z, rad.
    pub angle_min: f64,
    pub angle_increment: f64,
    /// Time between two beams, s; the first beam is measured at the stamp. 0: all beams are measured at the stamp.
    pub time_increment: f64,
    /// Smallest valid range, m.
    pub range_min: f64,
    pub range_max: f64,
    pub ranges: Vec<f32>,
}

/// A pose of a message, or its error.
pub(in crate::ros) type MessagePose = Result<Pose3, String>;

/// The used fields of `nav_msgs/msg/Odometry`.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ros) struct Odometry {
    pub stamp: Stamp,
    /// The frame that has this pose.
    pub child: String,
    /// `odom_from_child`.
    pub pose: MessagePose,
}

/// A `geometry_msgs/msg/TransformStamped` of a `tf2_msgs/msg/TFMessage`.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ros) struct Transform {
    pub stamp: Stamp,
    pub parent: String,
    pub child: String,
    pub parent_from_child: MessagePose,
}

impl LaserScan {
    pub(in crate::ros) fn read(bytes: &[u8], wire: Wire) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::LASER_SCAN, bytes, wire)?;
        let (stamp, frame) = header(&mut r)?;
        let angle_min = r.f32("angle_min")?;
        r.f32("angle_max")?;
        let angle_increment = r.f32("angle_increment")?;
        let time_increment = r.f32("time_increment")?;
        r.f32("scan_time")?;
        Ok(Self {
            stamp,
            frame,
            angle_min: f64::from(angle_min),
            angle_increment: f64::from(angle_increment),
            time_increment: f64::from(time_increment),
            range_min: f64::from(r.f32("range_min")?),
            range_max: f64::from(r.f32("range_max")?),
            ranges: r.f32_list("ranges")?,
        })
    }

    /// The sweep in the laser's frame.
    pub(in crate::ros) fn sweep(&self) -> LaserSweep<'_> {
        LaserSweep {
            stamp: self.stamp,
            angle_min: self.angle_min,
            angle_increment: self.angle_increment,
            time_increment: self.time_increment,
            range_min: self.range_min,
            range_max: self.range_max,
            ranges: &self.ranges,
        }
    }
}

impl Odometry {
    pub(in crate::ros) fn read(bytes: &[u8], wire: Wire) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::ODOMETRY, bytes, wire)?;
        let (stamp, _) = header(&mut r)?;
        let child = frame(&mut r, "child_frame_id")?;
        Ok(Self { stamp, child, pose: pose(&mut r, "pose")? })
    }
}

impl Transform {
    /// All transforms of a `tf2_msgs/msg/TFMessage`.
    pub(in crate::ros) fn read_all(bytes: &[u8], wire: Wire) -> Result<Vec<Self>, CdrError> {
        let mut r = CdrReader::new(types::TF, bytes, wire)?;
        // A transform is two times, two texts and seven numbers.
        let count = r.count("transforms", 72)?;
        (0..count).map(|_| Self::read(&mut r)).collect()
    }

    /// The transform of a `geometry_msgs/msg/TransformStamped` message.
    pub(in crate::ros) fn read_one(bytes: &[u8], wire: Wire) -> Result<Self, CdrError> {
        Self::read(&mut CdrReader::new(types::TRANSFORM, bytes, wire)?)
    }

    fn read(r: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        let (stamp, parent) = header(r)?;
        let child = frame(r, "child_frame_id")?;
        Ok(Self { stamp, parent, child, parent_from_child: pose(r, "transform")? })
    }
}

/// Stamp and frame of a `std_msgs/msg/Header`. The header of ROS 1 begins with a number.
pub(crate) fn header(r: &mut CdrReader<'_>) -> Result<(Stamp, String), CdrError> {
    if r.wire() == Wire::Ros1 {
        r.u32("header.seq")?;
    }
    let (seconds, nanos) = (r.i32("header.stamp.sec")?, r.u32("header.stamp.nanosec")?);
    let stamp = Stamp::from_nanos(i64::from(seconds) * 1_000_000_000 + i64::from(nanos));
    Ok((stamp, frame(r, "header.frame_id")?))
}

/// The name of a frame, without the leading slash that ROS 1 permits.
fn frame(r: &mut CdrReader<'_>, field: &'static str) -> Result<String, CdrError> {
    let name = r.string(field)?;
    Ok(name.strip_prefix('/').map_or(name.clone(), str::to_owned))
}

/// Position and quaternion (x, y, z, w).
fn pose(r: &mut CdrReader<'_>, field: &'static str) -> Result<MessagePose, CdrError> {
    let [x, y, z, qx, qy, qz, qw] = r.f64s(field)?;
    if [x, y, z].iter().any(|value| !value.is_finite()) {
        return Ok(Err(format!("the position is {x} {y} {z} m, expected finite numbers")));
    }
    let quaternion = Quaternion::new(qw, qx, qy, qz);
    let rotation = UnitQuaternion::try_new(quaternion, MIN_QUATERNION_NORM);
    let rotation = rotation.filter(|_| quaternion.norm() < MAX_QUATERNION_NORM);
    Ok(rotation.map(|rotation| Pose3::new(rotation, Vector3::new(x, y, z))).ok_or_else(|| {
        format!("the quaternion is {qx} {qy} {qz} {qw} (x y z w), which is not a rotation, expected length 1")
    }))
}

/// Norms between which a quaternion is normalised to a rotation. A quaternion beyond them is invalid: an orientation that was never set has
/// the norm 0. Source: ours.
const MIN_QUATERNION_NORM: f64 = 1e-6;
const MAX_QUATERNION_NORM: f64 = 1e6;
