//! Calibration by a whole recording: image delay, camera mount, wheels.
//!
//! | value | by | file |
//! |---|---|---|
//! | image delay | turn rate of the camera against the gyro | `image_delay.rs` |
//! | height, pitch, roll of the camera | floor in the depth images | `floor_plane.rs` |
//! | forward and lateral offset, yaw; wheels and wheelbase | trajectory of the camera against the wheels \[Censi13\] | `wheel_camera_fit.rs` |

pub(crate) mod error;
pub(crate) mod estimate;
pub(crate) mod floor_plane;
pub(crate) mod gyro_angle;
pub(crate) mod gyro_fit;
pub(crate) mod image_delay;
pub(crate) mod linear_fit;
pub(crate) mod planar_track;
pub(crate) mod segments;
#[cfg(test)]
mod tests;
pub(crate) mod turn_axis;
pub(crate) mod wheel_angles;
pub(crate) mod wheel_camera_fit;
