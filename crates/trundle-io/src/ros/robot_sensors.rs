//! Gyro and laser of a robot's bag, in the frame of the base and in the time of the odometry.

mod gyro;
mod mount;
mod scans;

pub(in crate::ros) use gyro::{ImuTopics, choose_gyro};
pub(in crate::ros) use mount::{BasePlace, bases};
pub(in crate::ros) use scans::{RosScans, ScanMessages, choose_scans};
