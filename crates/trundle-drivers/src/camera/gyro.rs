//! Samples of a camera's gyro.

use trundle_core::{Stamp, Vector3};

/// A sample of a camera's gyro.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroSample {
    /// Time of the sample on the clock of the images.
    pub device_stamp: Stamp,
    /// Turn rate around the axes of the depth camera \[rad/s\].
    pub rate: Vector3,
}
