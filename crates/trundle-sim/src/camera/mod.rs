//! The RGB-D camera: an exact renderer, then the sensor's noise.

mod candidates;
mod color_noise;
mod depth_noise;
mod lanes;
mod renderer;
mod seen;
mod sensor;

pub use color_noise::ColorNoise;
pub use depth_noise::DepthNoise;
pub use renderer::{Renderer, View};
pub use sensor::RgbdSensor;
