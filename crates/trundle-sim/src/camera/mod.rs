//! The RGB-D camera: an exact renderer, then the sensor's noise.

mod blur;
mod candidates;
mod color_noise;
mod depth_model;
mod depth_noise;
mod exposure;
mod lanes;
mod multi_path;
mod renderer;
mod seen;
mod sensor;
mod shadow;
mod tone;

pub use blur::blend;
pub use color_noise::ColorNoise;
pub use depth_noise::DepthNoise;
pub use exposure::Exposure;
pub use renderer::{Renderer, View};
pub use sensor::RgbdSensor;
