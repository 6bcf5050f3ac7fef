//! The RGB-D camera: an exact renderer, then the sensor's noise.

mod band;
mod blur;
mod color_noise;
mod depth_model;
mod depth_noise;
mod exposure;
mod footprint;
mod intersect_cuboid;
mod intersect_cylinder;
mod intersect_triangle;
mod lamps;
mod multi_path;
mod patch;
mod pyramid;
mod rays;
mod renderer;
mod round;
mod sensor;
mod shadow;
mod srgb;
mod surface;
mod tile;
mod tone;
mod world_view;

pub use blur::blend;
pub use color_noise::ColorNoise;
pub use depth_noise::DepthNoise;
pub use exposure::Exposure;
pub use renderer::{Renderer, View};
pub use sensor::RgbdSensor;
