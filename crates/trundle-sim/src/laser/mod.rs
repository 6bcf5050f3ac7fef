//! A laser that looks around in a horizontal plane.

mod config;
mod presets;
mod sweep;

pub use config::LaserConfig;
pub(crate) use sweep::Laser;
