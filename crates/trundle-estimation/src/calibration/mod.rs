//! Calibration of gyro, wheels and camera mount: online, and by a whole recording (`batch/`).

pub(crate) mod batch;
pub(crate) mod gyro_calibration;
pub(crate) mod scalar_kalman;
pub(crate) mod visual_yaw_segments;
pub(crate) mod wheel_calibration;
