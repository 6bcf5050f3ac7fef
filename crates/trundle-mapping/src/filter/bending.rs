use super::{ParticleMapper, closing::Tools, mapper::scaled, proposal::Proposal};
use crate::tiles::{DrawScratch, TileMap};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// The part of the filter that closes loops.
impl ParticleMapper {
    /// Covariance of the step to the last pose in its frame: m, m, rad.
    pub(super) fn step_covariance(&self, proposal: Option<&Proposal>) -> Matrix3<f64> {
        let least = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 2e-5));
        let Some(proposal) = proposal else { return least };
        let (s, c) = proposal.pose.theta.sin_cos();
        let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
        least + turn * scaled(proposal.covariance, self.config.map.resolution) * turn.transpose()
    }

    /// Looks for loops; where one is closed, the best particle's way and map are bent, and all go on from there.
    pub(super) fn close_loops(&mut self) -> Option<f64> {
        let trajectory = self.way();
        let poses: Vec<Pose2> = trajectory.iter().map(|(_, pose)| *pose).collect();
        let tools = Tools { config: &self.config, brush: &self.brush, likelihood: &self.likelihood };
        let closing = self.closer.look(&tools, &mut self.history, &poses)?;
        if closing.farthest < self.config.map.resolution {
            return None;
        }
        let mut map = TileMap::default();
        let mut draw = DrawScratch::default();
        for (scan, pose) in self.history.scans.iter().zip(&closing.poses) {
            self.shape.set_stored(&self.config, scan);
            self.brush.draw(&mut map, &mut draw, self.cells(*pose), &self.shape);
        }
        let stamps = trajectory.iter().map(|(stamp, _)| *stamp);
        self.ancestry.replace(stamps.zip(closing.poses.iter().copied()).collect());
        let last = *closing.poses.last().expect("invariant: loops are closed of some poses");
        let pose = self.cells(last);
        for particle in &mut self.particles {
            particle.pose = pose;
            particle.log_weight = 0.0;
            particle.map = map.clone();
        }
        self.parents = vec![0; self.particles.len()];
        Some(closing.farthest)
    }

    /// Keeps the store of scans within its bounds.
    pub(super) fn thin_history(&mut self) {
        if self.history.scans.len() > self.config.most_scans {
            let count = (self.config.most_scans / 2).min(self.ancestry.shared.len());
            let before = self.history.scans.len();
            self.history.thin(&mut self.ancestry.shared, count);
            let gone = before - self.history.scans.len();
            self.session = if self.session < count { self.session.div_ceil(2) } else { self.session - gone };
            self.closer.pending.clear();
        }
    }
}
