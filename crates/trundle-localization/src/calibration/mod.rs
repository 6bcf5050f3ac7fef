//! Online calibration of gyro and wheels.

pub(crate) mod gyro_calibration;
pub(crate) mod scalar_kalman;
pub(crate) mod visual_yaw_segments;
pub(crate) mod wheel_calibration;
