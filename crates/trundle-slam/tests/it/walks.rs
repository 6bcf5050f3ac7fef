//! Trajectories through the room.

use crate::room::{camera, stamp};
use nalgebra::Vector6;
use trundle_core::{ColorImage, DepthImage, Pose3, RgbdImage};

/// A turn on the spot: all around in 100 steps.
pub fn turned(step: usize) -> Pose3 {
    Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, step as f64 / 100.0 * std::f64::consts::TAU, 0.0))
}

/// A dark image.
pub fn dark(number: usize) -> RgbdImage {
    let camera = camera();
    let color = ColorImage::filled(camera.width(), camera.height(), [0; 3]);
    let depth = DepthImage::filled(camera.width(), camera.height(), 0.0);
    RgbdImage::new(stamp(number), color, depth).unwrap()
}
