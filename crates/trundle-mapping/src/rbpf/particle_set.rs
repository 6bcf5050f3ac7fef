//! Particles with their weights, their resampling and their trajectories.

use crate::particle_config::ParticleConfig;
use crate::rbpf::ancestry::Ancestry;
use crate::rbpf::proposal::Proposal;
use crate::rbpf::resampling::{effective, low_variance};
use crate::units::in_metres;
use trundle_core::{Pose2, Stamp};
use trundle_grid::tiles::TileMap;

/// Pose, weight and map of one particle.
#[derive(Debug, Clone)]
pub(crate) struct Particle {
    /// map_from_base, cells and rad.
    pub(crate) pose: Pose2,
    pub(crate) log_weight: f64,
    pub(crate) map: TileMap,
    /// Proposal that the pose was drawn from.
    pub(crate) proposal: Option<Proposal>,
}

/// All particles with their common history of poses.
#[derive(Debug)]
pub(crate) struct ParticleSet {
    pub(crate) particles: Vec<Particle>,
    /// Parent of each particle in the last column of the ancestry.
    pub(crate) parents: Vec<u16>,
    pub(crate) ancestry: Ancestry,
    /// Index of the first pose of this run in the trajectory.
    pub(crate) first_pose_of_run: usize,
}

impl ParticleSet {
    /// Particles at the origin with empty maps.
    pub(crate) fn new(count: usize) -> Self {
        let particle =
            Particle { pose: Pose2::IDENTITY, log_weight: 0.0, map: TileMap::default(), proposal: None };
        Self {
            particles: vec![particle; count],
            parents: (0..count as u16).collect(),
            ancestry: Ancestry::default(),
            first_pose_of_run: 0,
        }
    }

    /// Number of particles.
    pub(crate) fn len(&self) -> usize {
        self.particles.len()
    }

    /// Particle with the largest weight; the first of equal ones.
    pub(crate) fn best(&self) -> &Particle {
        &self.particles[self.best_index()]
    }

    fn best_index(&self) -> usize {
        let particles = &self.particles;
        let better = |best: usize, i: usize| {
            if particles[i].log_weight > particles[best].log_weight { i } else { best }
        };
        (1..particles.len()).fold(0, better)
    }

    /// Shifts the log-weights so that the largest is 0. Returns the effective number of particles.
    pub(crate) fn normalize(&mut self) -> f64 {
        let greatest = self.particles.iter().map(|p| p.log_weight).fold(f64::NEG_INFINITY, f64::max);
        for particle in &mut self.particles {
            particle.log_weight -= greatest;
        }
        effective(&self.weights())
    }

    /// Appends the poses of all particles to their trajectories.
    pub(crate) fn record(&mut self, config: &ParticleConfig, stamp: Stamp) {
        let poses = self.particles.iter().map(|p| in_metres(config, p.pose));
        self.ancestry.push(stamp, poses, &self.parents);
        self.parents = (0..self.particles.len() as u16).collect();
    }

    /// Low-variance resampling with one random number in [0, 1).
    pub(crate) fn resample(&mut self, uniform: f64) {
        self.parents = low_variance(&self.weights(), uniform);
        for i in 0..self.particles.len() {
            let parent = usize::from(self.parents[i]);
            if parent != i {
                self.particles[i] = self.particles[parent].clone();
            }
        }
        self.particles.iter_mut().for_each(|p| p.log_weight = 0.0);
    }

    /// Poses of the best particle at all processed scans, m.
    pub(crate) fn trajectory(&self) -> Vec<(Stamp, Pose2)> {
        // The last resampling is not in the ancestry yet: parents lead from the particles to its last column.
        self.ancestry.trajectory(usize::from(self.parents[self.best_index()]))
    }

    /// Moves all particles to the end of one trajectory (m), at `pose` (cells), with one map.
    pub(crate) fn collapse(&mut self, trajectory: Vec<(Stamp, Pose2)>, pose: Pose2, map: &TileMap) {
        self.ancestry.replace(trajectory);
        for particle in &mut self.particles {
            particle.pose = pose;
            particle.log_weight = 0.0;
            particle.map = map.clone();
        }
        self.parents = vec![0; self.particles.len()];
    }

    fn weights(&self) -> Vec<f64> {
        self.particles.iter().map(|p| p.log_weight.exp()).collect()
    }
}
