//! Messages of the topics, each from a view of the run.

pub mod camera;
pub mod goal;
pub mod map;
pub mod plan;
pub mod pose;
pub mod scan;
pub mod state;
pub mod telemetry;
pub mod transforms;

use foxglove::messages::{Pose, Quaternion, Timestamp, Vector3};
use trundle_core::{Pose2, Stamp};

/// Frame of the map.
const MAP_FRAME: &str = "map";
/// Frame of the odometry.
const ODOM_FRAME: &str = "odom";
/// Frame of the base.
const BASE_FRAME: &str = "base_link";
/// Frame of the camera's image.
const CAMERA_FRAME: &str = "camera";
/// Nanoseconds of a second. Source: SI.
const NANOS_PER_S: u64 = 1_000_000_000;

/// A stamp of the run. Stamps outside the years 1970 to 2106 become the nearest of them.
fn timestamp(stamp: Stamp) -> Timestamp {
    let nanos = u64::try_from(stamp.nanos).unwrap_or(0);
    let seconds = u32::try_from(nanos / NANOS_PER_S).unwrap_or(u32::MAX);
    Timestamp::new(seconds, (nanos % NANOS_PER_S) as u32)
}

fn pose3(pose: Pose2) -> Pose {
    Pose { position: Some(position(pose)), orientation: Some(rotation(pose)) }
}

fn position(pose: Pose2) -> Vector3 {
    Vector3 { x: pose.x, y: pose.y, z: 0.0 }
}

/// The heading as a rotation about z.
fn rotation(pose: Pose2) -> Quaternion {
    let (z, w) = (pose.theta / 2.0).sin_cos();
    Quaternion { x: 0.0, y: 0.0, z, w }
}
