//! The fixed-lag smoother: the poses of the last seconds and the calibration, from all measurements at once.

pub(crate) mod calibration;
pub(crate) mod config;
mod error_process;
mod factors;
pub(crate) mod fixed_lag;
pub(crate) mod innovation;
mod intake;
mod keyframe;
pub(crate) mod measurement;
mod motion_buffer;
mod prediction;
mod preintegration;
mod prior;
mod scan_intake;
mod state;
#[cfg(test)]
mod tests;
mod visual_intake;
mod visual_maps;
mod window;
