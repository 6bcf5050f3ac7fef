//! Search, proof and correction of loops along the trajectory.

use super::{
    candidates::{Candidate, MAX_SEARCH_RADIUS_M, candidates},
    submap::{Submaps, thinned},
};
use crate::filter_models::FilterModels;
use crate::loop_closing::scan_history::ScanHistory;
use crate::particle_config::ParticleConfig;
use crate::pose_graph::{Constraint, reach, solve};
use crate::scan_match::cloud_match::{CloudMatch, CloudMatcher, MIN_PROOF_NATS};
use crate::scan_match::scan_points::ScanPoints;
use crate::units::{in_cells, in_metres};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;
use trundle_grid::tiles::TileMap;

/// Searches for loops along the trajectory, and corrects the trajectory if one is proved.
#[derive(Debug, Default)]
pub(crate) struct LoopCloser {
    /// Path length since the last search, m.
    pub(crate) driven: f64,
    pub(crate) pending: Vec<Constraint>,
    submaps: Submaps,
}

/// Correction of the trajectory by a closed loop.
#[derive(Debug)]
pub(crate) struct LoopCorrection {
    /// Corrected poses, m.
    pub(crate) poses: Vec<Pose2>,
    /// Largest displacement of a pose, m.
    pub(crate) farthest: f64,
}

/// Path length of the newest scans that are matched together \[m\]. Source: ours.
const SUBMAP_LENGTH_M: f64 = 8.0;
/// Maximum number of scans of the newest submap. Source: ours.
const MAX_SUBMAP_SCANS: usize = 24;
/// Radius about a candidate of the scans that form the reference map \[m\], plus twice the drift. Source: ours.
const REFERENCE_RADIUS_M: f64 = 10.0;
/// Maximum number of scans of the reference map. Source: ours.
const MAX_REFERENCE_SCANS: usize = 48;
/// Maximum number of candidates matched in one search. Source: ours.
const MAX_CANDIDATES: usize = 2;

impl LoopCloser {
    /// Searches for an earlier part of the trajectory that the end of `poses` (m) has returned to.
    pub(crate) fn search(
        &mut self,
        models: &FilterModels,
        history: &mut ScanHistory,
        poses: &[Pose2],
    ) -> Option<LoopCorrection> {
        let distances: Vec<f64> = std::iter::once(0.0)
            .chain(poses.windows(2).scan(0.0, |distance, pair| {
                *distance += pair[0].distance(&pair[1]);
                Some(*distance)
            }))
            .collect();
        let distance = *distances.last()?;
        let constraints = history.constraints(poses);
        let last = poses.len() - 1;
        let reached = reach(poses, &constraints, last);
        let found = candidates(poses, &distances, &reached);
        let own: Vec<usize> = {
            let from = distances.partition_point(|w| *w < distance - SUBMAP_LENGTH_M);
            thinned(poses, (from..=last).rev(), 0.3, MAX_SUBMAP_SCANS)
        };
        let now = poses[last];
        let own_map = self.submaps.draw(models, history, &own, |k| now.inverse() * poses[k]);
        for candidate in found.iter().take(MAX_CANDIDATES) {
            let Some(constraint) = self.match_candidate(models, history, poses, candidate, &own_map) else {
                continue;
            };
            return self.confirmed_correction(history, poses, constraint);
        }
        None
    }

    fn match_candidate(
        &mut self,
        models: &FilterModels,
        history: &ScanHistory,
        poses: &[Pose2],
        candidate: &Candidate,
        (own_map, own_cloud): &(TileMap, ScanPoints),
    ) -> Option<Constraint> {
        let (config, last) = (&models.config, poses.len() - 1);
        let drift = candidate.reached.covariance;
        let far =
            (REFERENCE_RADIUS_M + 2.0 * drift[(0, 0)].max(drift[(1, 1)]).sqrt()).min(MAX_SEARCH_RADIUS_M);
        let near = |&k: &usize| poses[k].distance(&poses[candidate.nearest]) < far;
        let apart = (2.0 * far / MAX_REFERENCE_SCANS as f64).max(0.4);
        let half = |range: &mut dyn Iterator<Item = usize>| {
            thinned(poses, range.filter(near), apart, MAX_REFERENCE_SCANS / 2)
        };
        let onward = half(&mut (candidate.nearest..candidate.range.end));
        let back = half(&mut (candidate.range.start..candidate.nearest).rev());
        let mut which: Vec<usize> = back.into_iter().chain(onward).collect();
        which.sort_unstable();
        let (map, cloud) = self.submaps.draw(models, history, &which, |k| poses[k]);
        let per_metre = 1.0 / config.map.resolution;
        let scale = Matrix3::from_diagonal(&Vector3::new(per_metre, per_metre, 1.0));
        let min = Matrix3::from_diagonal(&Vector3::new(4.0, 4.0, 0.02 * 0.02));
        let covariance = scale * candidate.reached.covariance * scale + min;
        let reach = |k: usize| (3.0 * covariance[(k, k)].sqrt()).clamp(10.0, MAX_SEARCH_RADIUS_M * per_metre);
        let turn = (3.0 * covariance[(2, 2)].sqrt()).clamp(0.05, 0.8);
        let finder = CloudMatcher { config, likelihood: &models.likelihood, cloud: own_cloud };
        let found =
            finder.find(&map, in_cells(config, poses[last]), &covariance, ((reach(0), reach(1)), turn), 2);
        let best = *found.first()?;
        let rival = found.get(1).map_or(f64::NEG_INFINITY, |rival| rival.log_likelihood);
        let back = CloudMatcher { config, likelihood: &models.likelihood, cloud: &cloud };
        let (back_explained, back_contradicted) = back.fit(own_map, best.pose.inverse());
        // The score of a place with all hits on unknown ground.
        let unseen = 0.5 * config.outliers.ln() * own_cloud.points.len() as f64 / config.correlation;
        let proved = best.log_likelihood - rival.max(unseen) > MIN_PROOF_NATS
            && back_contradicted < 0.5 * back_explained
            && best.degenerate == 0;
        proved.then(|| constraint(config, poses, &which, &best))
    }

    /// Accepts a constraint that an earlier one at some distance confirms; corrects the trajectory if necessary.
    fn confirmed_correction(
        &mut self,
        history: &mut ScanHistory,
        poses: &[Pose2],
        constraint: Constraint,
    ) -> Option<LoopCorrection> {
        let last = poses.len() - 1;
        let now = poses[constraint.from as usize] * constraint.from_to;
        let off = now.inverse() * poses[last];
        let known = off.position().norm() < 0.3 && off.theta.abs() < 0.05;
        let agrees = |other: &Constraint| {
            let then = poses[other.from as usize] * other.from_to;
            let step = poses[other.to as usize].inverse() * poses[last];
            let off = (then * step).inverse() * now;
            let distance = step.position().norm();
            off.position().norm() < 0.2 + 0.04 * distance && off.theta.abs() < 0.05
        };
        if !known && !self.pending.iter().any(agrees) {
            self.pending.push(constraint);
            let excess = self.pending.len().saturating_sub(4);
            self.pending.drain(..excess);
            return None;
        }
        let ties_before = history.loops.len();
        if !known {
            let agreeing: Vec<Constraint> = self.pending.drain(..).filter(|other| agrees(other)).collect();
            history.loops.extend(agreeing);
        }
        history.loops.push(constraint);
        history.measure(poses);
        if known && off.position().norm() < 0.05 && off.theta.abs() < 0.01 {
            return None;
        }
        let constraints = history.constraints(poses);
        let corrected = solve(poses.to_vec(), &constraints);
        let fits = |corrected: &Vec<Pose2>| {
            history.loops.iter().all(|constraint| {
                let residual = constraint
                    .residual(corrected[constraint.from as usize], corrected[constraint.to as usize]);
                residual.xy().norm() < 1.0 && residual.z.abs() < 0.2
            })
        };
        let Some(corrected) = corrected.filter(fits) else {
            history.loops.truncate(ties_before);
            return None;
        };
        let farthest = corrected.iter().zip(poses).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        Some(LoopCorrection { poses: corrected, farthest })
    }
}

/// The constraint between the pose nearest to the found position and the last pose.
fn constraint(config: &ParticleConfig, poses: &[Pose2], which: &[usize], found: &CloudMatch) -> Constraint {
    let metre = config.map.resolution;
    let pose = in_metres(config, found.pose);
    let nearest =
        which.iter().copied().min_by(|&a, &b| poses[a].distance(&pose).total_cmp(&poses[b].distance(&pose)));
    let from = nearest.expect("invariant: a map is drawn from scans");
    let (s, c) = pose.theta.sin_cos();
    let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    let scale = Matrix3::from_diagonal(&Vector3::new(metre, metre, 1.0));
    let weak = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1.0));
    let covariance = (found.information + weak).try_inverse().expect("invariant: a positive matrix");
    let floor = Matrix3::from_diagonal(&Vector3::new(0.03 * 0.03, 0.03 * 0.03, 0.005 * 0.005));
    Constraint {
        from: from as u32,
        to: poses.len() as u32 - 1,
        from_to: poses[from].inverse() * pose,
        covariance: turn * scale * covariance * scale * turn.transpose() + floor,
    }
}
