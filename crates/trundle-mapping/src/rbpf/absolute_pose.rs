//! Absolute pose prior from odometry without drift.

use crate::particle_config::ParticleConfig;
use crate::units::{in_cells, scaled};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// The robot's pose by odometry without drift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AbsolutePose {
    /// map_from_base, cells and rad.
    pub(crate) pose: Pose2,
    /// Covariance: cells, cells, rad; map frame.
    pub(crate) covariance: Matrix3<f64>,
}

impl AbsolutePose {
    /// The prior of a base at `map_from_base` by the odometry, m and rad. `None` if the configuration has no `pose_prior`.
    pub(crate) fn new(config: &ParticleConfig, map_from_base: Pose2) -> Option<Self> {
        let prior = config.pose_prior.as_ref()?;
        let sigma = Vector3::new(prior.shift, prior.shift, prior.turn);
        let per_metre = 1.0 / config.map.resolution;
        let pose = in_cells(config, map_from_base);
        let covariance = Matrix3::from_diagonal(&sigma.component_mul(&sigma));
        Some(Self { pose, covariance: scaled(covariance, per_metre) })
    }
}
