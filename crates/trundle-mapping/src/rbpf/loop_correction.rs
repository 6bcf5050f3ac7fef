//! Loop closing of the filter: loop searches, the redraw of the corrected map, and thinning of the history.

use crate::loop_closing::loop_closer::LoopTools;
use crate::rbpf::map_redraw::MapRedraw;
use crate::rbpf::mapper::ParticleMapper;
use crate::rbpf::proposal::Proposal;
use crate::rbpf::units::{in_metres, scaled};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// Cells redrawn with one scan: about ten times the cells that thirty particles update. A smaller number leaves the robot
/// longer in the uncorrected map. Source: ours.
const CELLS_PER_SCAN: usize = 4_000_000;
/// Minimum cost of a redrawn scan [cells]. Source: ours.
const MIN_SCAN_COST_CELLS: usize = 500;
/// Path length between two loop searches [m]. Source: ours.
const LOOP_SEARCH_INTERVAL_M: f64 = 2.0;

/// The part of the filter that closes loops.
impl ParticleMapper {
    /// Covariance of the step to the last pose in its frame: m, m, rad.
    pub(crate) fn step_covariance(&self, proposal: Option<&Proposal>) -> Matrix3<f64> {
        let least = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 2e-5));
        let Some(proposal) = proposal else { return least };
        let (s, c) = proposal.pose.theta.sin_cos();
        let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
        least + turn * scaled(proposal.covariance, self.config.map.resolution) * turn.transpose()
    }

    /// Looks for loops each 2 m of way; where one is closed, the best particle's way and map are bent, some scans with each
    /// call, and all go on from there: then how far the farthest pose went, m.
    pub(crate) fn close_loops(&mut self, driven: f64) -> Option<f64> {
        self.loop_closer.driven += driven;
        if self.redraw.is_some() {
            return self.advance_redraw(CELLS_PER_SCAN).1;
        }
        if self.loop_closer.driven < LOOP_SEARCH_INTERVAL_M {
            return None;
        }
        self.loop_closer.driven = 0.0;
        let poses: Vec<Pose2> = self.full_trajectory().into_iter().map(|(_, pose)| pose).collect();
        let tools =
            LoopTools { config: &self.config, ray_update: &self.ray_update, likelihood: &self.likelihood };
        let closing = self.loop_closer.look(&tools, &mut self.history, &poses)?;
        if closing.farthest >= self.config.map.resolution {
            self.redraw =
                Some(MapRedraw { poses: closing.poses, farthest: closing.farthest, ..MapRedraw::default() });
        }
        None
    }

    /// Finishes what is under way, as after the last scan of a log: a map that a loop bends is drawn to its end.
    pub fn finish(&mut self) {
        self.advance_redraw(usize::MAX);
    }

    /// Draws scans at their bent poses for about `budget` cells, and goes over to the new map when all are drawn. How many cells
    /// were told, and how far the farthest pose went when it is done.
    pub(crate) fn advance_redraw(&mut self, budget: usize) -> (usize, Option<f64>) {
        let Some(mut bending) = self.redraw.take() else { return (0, None) };
        let mut cells = 0;
        while cells < budget && bending.drawn < bending.poses.len() {
            let pose = bending.poses[bending.drawn];
            cells += self.redraw_scan(&mut bending, pose);
        }
        if bending.drawn < bending.poses.len() {
            self.redraw = Some(bending);
            return (cells, None);
        }
        (cells, Some(self.apply_redraw(bending)))
    }

    fn redraw_scan(&self, bending: &mut MapRedraw, pose: Pose2) -> usize {
        self.history.scans[bending.drawn].unpack_into(&self.config, &mut bending.shape);
        bending.drawn += 1;
        let pose = self.cells(pose);
        self.ray_update.apply(&mut bending.map, &mut bending.draw, pose, &bending.shape.rays)
            + MIN_SCAN_COST_CELLS
    }

    /// All particles go on from the bent way, behind which the best one's scans since then follow as they were.
    fn apply_redraw(&mut self, mut bending: MapRedraw) -> f64 {
        let way = self.full_trajectory();
        let bent = bending.poses.len();
        let moved = bending.poses[bent - 1] * way[bent - 1].1.inverse();
        let mut trajectory = way;
        for (k, (_, pose)) in trajectory.iter_mut().enumerate() {
            *pose = if k < bent { bending.poses[k] } else { moved * *pose };
            if k >= bent {
                self.redraw_scan(&mut bending, *pose);
            }
        }
        let last = trajectory.last().expect("invariant: a way that is bent has poses").1;
        self.ancestry.replace(trajectory);
        let pose = self.cells(last);
        for particle in &mut self.particles {
            particle.pose = pose;
            particle.log_weight = 0.0;
            particle.map = bending.map.clone();
        }
        self.parents = vec![0; self.particles.len()];
        debug_assert!(in_metres(&self.config, pose).distance(&last) < 1e-6, "cells and metres agree");
        bending.farthest
    }

    /// Keeps the store of scans within its bounds.
    pub(crate) fn thin_history(&mut self) {
        if self.history.scans.len() > self.config.most_scans {
            // Scans that are being drawn must not be renumbered.
            self.finish();
            let (count, before) = (self.config.most_scans / 2, self.history.scans.len());
            let mut way = self.full_trajectory();
            self.history.thin(&mut way, count);
            self.ancestry.thin(count);
            let gone = before - self.history.scans.len();
            self.first_pose_of_run = if self.first_pose_of_run < count {
                self.first_pose_of_run.div_ceil(2)
            } else {
                self.first_pose_of_run - gone
            };
            self.loop_closer.pending.clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loop_closing::stored_scan::StoredScan;
    use crate::particle_config::ParticleConfig;
    use crate::scan_match::scan_points::ScanPoints;
    use trundle_core::{Beam, Scan, Stamp, Vector2};

    /// A filter that has seen `scans` along a straight way, which a loop bends.
    fn bent(scans: usize) -> ParticleMapper {
        let config = ParticleConfig { particles: 3, ..ParticleConfig::default() };
        let mut mapper = ParticleMapper::new(config, 1).unwrap();
        let beams = (0..90).map(|k| Beam::Hit { range: 3.0 + 0.01 * f64::from(k % 7) }).collect();
        let scan = Scan::new(Stamp::default(), Vector2::zeros(), -1.5, 0.03, beams).unwrap();
        let mut shape = ScanPoints::default();
        shape.set(&mapper.config, &scan);
        let way: Vec<_> = (0..scans)
            .map(|k| (Stamp::from_nanos(k as i64), Pose2::new(0.05 * k as f64, 0.0, 0.0)))
            .collect();
        way.iter().for_each(|_| mapper.history.push(StoredScan::new(&shape), Matrix3::identity() * 1e-4));
        let turn = |pose: Pose2| Pose2::new(0.0, 0.0, 0.1) * pose;
        let poses = way[..scans - 5].iter().map(|(_, pose)| turn(*pose)).collect();
        mapper.ancestry.replace(way);
        mapper.redraw = Some(MapRedraw { poses, farthest: 1.0, ..MapRedraw::default() });
        mapper
    }

    #[test]
    fn a_slice_of_bending_does_not_grow_with_the_run_and_ends_as_in_one_go() {
        const BUDGET: usize = 20_000;
        for scans in [40, 400] {
            let (mut sliced, mut once) = (bent(scans), bent(scans));
            let (mut most, mut slices, mut all) = (0, 0, 0);
            loop {
                let (cells, done) = sliced.advance_redraw(BUDGET);
                (most, slices, all) = (most.max(cells), slices + 1, all + cells);
                if done.is_some() {
                    break;
                }
            }
            once.finish();
            assert!(most < BUDGET + 5_000, "{most} cells in one slice");
            assert!(slices >= all / (BUDGET + 5_000), "{slices} slices");
            assert!(once.redraw.is_none() && once.grid() == sliced.grid());
            // What came after the bent part is carried along as it was.
            let end = Pose2::new(0.0, 0.0, 0.1) * Pose2::new(0.05 * (scans - 1) as f64, 0.0, 0.0);
            assert!(sliced.pose().distance(&end) < 1e-6);
            assert_eq!(sliced.trajectory().len(), scans);
        }
    }
}
