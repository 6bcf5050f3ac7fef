//! Odometry of the filter: learnt noise and bias, and the frame of odometry without drift.

use crate::particle_config::ParticleConfig;
use crate::rbpf::absolute_pose::AbsolutePose;
use crate::rbpf::odometry_bias::OdometryBias;
use crate::rbpf::odometry_noise::OdometryNoise;
use crate::rbpf::proposal::Proposal;
use crate::rbpf::update_gate::OdometryStep;
use crate::units::scaled;
use nalgebra::Matrix3;
use trundle_core::Pose2;

/// Errors of the odometry, learnt from the scan matches.
#[derive(Debug, Clone, Default)]
pub(crate) struct OdometryModel {
    /// Scale of the random errors.
    pub(crate) noise: OdometryNoise,
    /// Systematic errors.
    pub(crate) bias: OdometryBias,
    /// map_from_odom of odometry without drift, m and rad. The first pose of that odometry is the map's origin.
    pub(crate) map_from_odom: Option<Pose2>,
}

impl OdometryModel {
    /// Absolute pose of the base from odometry without drift; `None` for dead reckoning.
    pub(crate) fn absolute_pose(
        &self,
        config: &ParticleConfig,
        odom_from_base: Pose2,
    ) -> Option<AbsolutePose> {
        self.map_from_odom.and_then(|origin| AbsolutePose::new(config, origin * odom_from_base))
    }

    /// Corrected motion of a step (m, rad) with its covariance.
    pub(crate) fn motion(&self, step: &OdometryStep) -> (Pose2, Matrix3<f64>) {
        if step.jumped || step.silent {
            (step.motion, step.covariance)
        } else {
            (self.bias.corrected(step.motion), self.noise.scaled(&step.covariance))
        }
    }

    /// Updates noise and bias by the match of a step. `resolution`: side of a cell, m.
    pub(crate) fn learn(&mut self, step: &OdometryStep, proposal: Option<&Proposal>, resolution: f64) {
        let Some(proposal) = proposal.filter(|_| !step.jumped && !step.silent) else { return };
        if proposal.slipped {
            self.noise.doubt();
        } else if let Some(innovation) = proposal.innovation {
            let configured = step.covariance;
            let noise = scaled(self.noise.scaled(&configured), 1.0 / resolution).diagonal();
            self.bias.learn(step.motion, &innovation, noise, resolution);
            self.noise.learn(&innovation, &scaled(configured, 1.0 / resolution));
        }
    }
}
