//! Odometry of wheels and gyro.

pub(crate) mod continuous_odometry;
pub(crate) mod motion_increment;
pub(crate) mod odometry_events;
pub(crate) mod ready_odometry;
pub(crate) mod report;
pub(crate) mod state;
pub(crate) mod turn_integral;
pub(crate) mod wheel_odometry;
pub(crate) mod wheels_from_odometry;
