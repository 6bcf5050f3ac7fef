//! Rao-Blackwellised particle filter: each particle is a trajectory with its own map (docs/methods.md A3).

pub(crate) mod absolute_pose;
pub(crate) mod ancestry;
pub(crate) mod given_map;
pub(crate) mod loop_correction;
pub(crate) mod map_publisher;
pub(crate) mod map_redraw;
pub(crate) mod mapper;
pub(crate) mod motion_model;
pub(crate) mod odometry_bias;
pub(crate) mod odometry_model;
pub(crate) mod odometry_noise;
pub(crate) mod particle_set;
mod propagate;
pub(crate) mod proposal;
pub(crate) mod resampling;
pub(crate) mod rng;
mod scan_difference;
pub(crate) mod scan_update;
pub(crate) mod update_gate;

pub use mapper::ParticleMapper;
pub use propagate::{propagate_trajectory, propagated_poses};
pub use scan_update::{MappingPause, Processed, Refusal, ScanUpdate};

#[cfg(test)]
mod tests;
