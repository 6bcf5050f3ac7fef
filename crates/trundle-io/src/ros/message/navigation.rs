//! Odometry, path and map.

use super::RosMessage;
use crate::ros::cdr_writer::CdrWriter;
use nalgebra::Matrix3;
use trundle_core::{Cell, OccupancyGrid, Odometry, Pose2, Pose3, Stamp};

/// Variance of quantities that a planar base does not measure: height, roll, pitch \[m², rad²\]. Source: ours, very large.
const UNMEASURED_VARIANCE: f64 = 1e6;
/// Indices of x, y and heading among x, y, z, roll, pitch, yaw. Source: `geometry_msgs/PoseWithCovariance`.
const PLANAR: [usize; 3] = [0, 1, 5];

/// `nav_msgs/msg/Odometry`: `frame_from_child` with its covariance, which remains a right perturbation.
#[must_use]
pub fn odometry(frame: &str, child: &str, odometry: &Odometry) -> RosMessage {
    let writer = CdrWriter::with_header(odometry.stamp, frame).string(child);
    let writer = writer.pose(Pose3::from_pose2(odometry.pose)).f64s(six_by_six(&odometry.covariance));
    RosMessage::new("nav_msgs/msg/Odometry", writer.twist(odometry.twist).f64s([0.0; 36]))
}

/// `nav_msgs/msg/Odometry` of a pose alone: covariance and twist are 0.
#[must_use]
pub fn odometry_pose(stamp: Stamp, frame: &str, child: &str, pose: Pose3) -> RosMessage {
    let writer = CdrWriter::with_header(stamp, frame).string(child).pose(pose);
    RosMessage::new("nav_msgs/msg/Odometry", writer.f64s([0.0; 36 + 6 + 36]))
}

/// `nav_msgs/msg/Path`: `frame_from_base` each.
#[must_use]
pub fn path(stamp: Stamp, frame: &str, poses: &[Pose2]) -> RosMessage {
    let writer = CdrWriter::with_header(stamp, frame).count(poses.len());
    let pose = |writer: CdrWriter, pose: &Pose2| writer.header(stamp, frame).pose(Pose3::from_pose2(*pose));
    RosMessage::new("nav_msgs/msg/Path", poses.iter().fold(writer, pose))
}

/// `nav_msgs/msg/OccupancyGrid`: 0 free, 100 occupied, -1 unknown.
#[must_use]
pub fn map(stamp: Stamp, frame: &str, grid: &OccupancyGrid) -> RosMessage {
    let geometry = grid.geometry();
    let cell = |cell: &Cell| match cell {
        Cell::Free => 0,
        Cell::Occupied => 100,
        _ => u8::MAX, // -1 as int8
    };
    let cells: Vec<u8> = grid.cells().iter().map(cell).collect();
    let writer = CdrWriter::with_header(stamp, frame).stamp(stamp);
    let writer = writer.f32(geometry.resolution as f32).count(geometry.width).count(geometry.height);
    let origin = Pose3::from_pose2(Pose2::new(geometry.origin.x, geometry.origin.y, 0.0));
    RosMessage::new("nav_msgs/msg/OccupancyGrid", writer.pose(origin).bytes(&cells))
}

/// A covariance of x, y and heading among the six of ROS, row by row.
fn six_by_six(covariance: &Matrix3<f64>) -> [f64; 36] {
    let mut all = [0.0; 36];
    for i in 0..6 {
        all[7 * i] = UNMEASURED_VARIANCE;
    }
    for (i, row) in PLANAR.iter().enumerate() {
        for (j, column) in PLANAR.iter().enumerate() {
            all[6 * row + column] = covariance[(i, j)];
        }
    }
    all
}
