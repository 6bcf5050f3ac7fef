//! A laser that scans a horizontal plane.

mod config;
mod presets;
mod sweep;

pub use config::LaserConfig;
pub(crate) use sweep::Laser;
