use super::{
    candidates::{Candidate, WIDEST, candidates},
    submap::{Submaps, cells, thinned},
};
use crate::loop_closing::scan_history::History;
use crate::particle_config::ParticleConfig;
use crate::pose_graph::{Tie, reach, solve};
use crate::scan_match::cloud_match::{Finder, Found};
use crate::scan_match::likelihood::Likelihood;
use crate::scan_match::scan_points::ScanShape;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;
use trundle_grid::tiles::{RayUpdate, TileMap};

/// What loop closing works with.
pub(crate) struct Tools<'a> {
    pub(crate) config: &'a ParticleConfig,
    pub(crate) ray_update: &'a RayUpdate,
    pub(crate) likelihood: &'a Likelihood,
}

/// Looks for loops along the way, and bends it where one is proved.
#[derive(Debug, Default)]
pub(crate) struct Closer {
    /// What was driven since the last look, m.
    pub(crate) driven: f64,
    pub(crate) pending: Vec<Tie>,
    submaps: Submaps,
}

/// What became of a look for loops.
#[derive(Debug)]
pub(crate) struct Closing {
    /// The poses, bent.
    pub(crate) poses: Vec<Pose2>,
    /// How far the farthest went, m.
    pub(crate) farthest: f64,
}

/// The way whose scans are matched together, m.
const SUBMAP_WAY: f64 = 8.0;
const MOST_SCANS: usize = 24;
/// Scans so near to a candidate, and within what the robot may be off, make the map to match against, m.
const REFERENCE: f64 = 10.0;
const MOST_REFERENCE: usize = 48;
/// Candidates looked at in one go.
const MOST_CANDIDATES: usize = 2;

/// By so much a place must be better than every other one, and than none, nats: 1 in 3000.
pub(crate) const PROOF: f64 = 16.0;

impl Closer {
    /// Looks whether the end of `poses` (m) has come back to an earlier part of them.
    pub(crate) fn look(
        &mut self,
        tools: &Tools<'_>,
        history: &mut History,
        poses: &[Pose2],
    ) -> Option<Closing> {
        let ways: Vec<f64> = std::iter::once(0.0)
            .chain(poses.windows(2).scan(0.0, |way, pair| {
                *way += pair[0].distance(&pair[1]);
                Some(*way)
            }))
            .collect();
        let way = *ways.last()?;
        let ties = history.ties(poses);
        let last = poses.len() - 1;
        let reached = reach(poses, &ties, last);
        let found = candidates(poses, &ways, &reached);
        let own: Vec<usize> = {
            let from = ways.partition_point(|w| *w < way - SUBMAP_WAY);
            thinned(poses, (from..=last).rev(), 0.3, MOST_SCANS)
        };
        let now = poses[last];
        let own_map =
            self.submaps.draw((tools.config, tools.ray_update), history, &own, |k| now.inverse() * poses[k]);
        for candidate in found.iter().take(MOST_CANDIDATES) {
            let Some(tie) = self.match_candidate(tools, history, poses, candidate, &own_map) else {
                continue;
            };
            return self.accept(history, poses, tie);
        }
        None
    }

    fn match_candidate(
        &mut self,
        tools: &Tools<'_>,
        history: &History,
        poses: &[Pose2],
        candidate: &Candidate,
        (own_map, own_cloud): &(TileMap, ScanShape),
    ) -> Option<Tie> {
        let (config, last) = (tools.config, poses.len() - 1);
        let drift = candidate.reached.covariance;
        let far = (REFERENCE + 2.0 * drift[(0, 0)].max(drift[(1, 1)]).sqrt()).min(WIDEST);
        let near = |&k: &usize| poses[k].distance(&poses[candidate.nearest]) < far;
        let apart = (2.0 * far / MOST_REFERENCE as f64).max(0.4);
        let half = |range: &mut dyn Iterator<Item = usize>| {
            thinned(poses, range.filter(near), apart, MOST_REFERENCE / 2)
        };
        let onward = half(&mut (candidate.nearest..candidate.range.end));
        let back = half(&mut (candidate.range.start..candidate.nearest).rev());
        let mut which: Vec<usize> = back.into_iter().chain(onward).collect();
        which.sort_unstable();
        let (map, cloud) = self.submaps.draw((config, tools.ray_update), history, &which, |k| poses[k]);
        let per_metre = 1.0 / config.map.resolution;
        let scale = Matrix3::from_diagonal(&Vector3::new(per_metre, per_metre, 1.0));
        let least = Matrix3::from_diagonal(&Vector3::new(4.0, 4.0, 0.02 * 0.02));
        let covariance = scale * candidate.reached.covariance * scale + least;
        let reach = |k: usize| (3.0 * covariance[(k, k)].sqrt()).clamp(10.0, WIDEST * per_metre);
        let turn = (3.0 * covariance[(2, 2)].sqrt()).clamp(0.05, 0.8);
        let finder = Finder { config, likelihood: tools.likelihood, cloud: own_cloud };
        let found =
            finder.find(&map, cells(config, poses[last]), &covariance, ((reach(0), reach(1)), turn), 2);
        let best = *found.first()?;
        let rival = found.get(1).map_or(f64::NEG_INFINITY, |rival| rival.log_likelihood);
        let back = Finder { config, likelihood: tools.likelihood, cloud: &cloud };
        let (back_explained, back_contradicted) = back.fit(own_map, best.pose.inverse());
        // Against a place that was never seen, where every hit would lie on unknown ground.
        let unseen = 0.5 * config.outliers.ln() * own_cloud.points.len() as f64 / config.correlation;
        let proved = best.log_likelihood - rival.max(unseen) > PROOF
            && back_contradicted < 0.5 * back_explained
            && best.degenerate == 0;
        proved.then(|| tie(config, poses, &which, &best))
    }

    /// Takes a tie in when another one, some way before, says the same; bends the way where it must.
    fn accept(&mut self, history: &mut History, poses: &[Pose2], tie: Tie) -> Option<Closing> {
        let last = poses.len() - 1;
        let now = poses[tie.from as usize] * tie.from_to;
        let off = now.inverse() * poses[last];
        let known = off.position().norm() < 0.3 && off.theta.abs() < 0.05;
        let agrees = |other: &Tie| {
            let then = poses[other.from as usize] * other.from_to;
            let step = poses[other.to as usize].inverse() * poses[last];
            let off = (then * step).inverse() * now;
            let way = step.position().norm();
            off.position().norm() < 0.2 + 0.04 * way && off.theta.abs() < 0.05
        };
        if !known && !self.pending.iter().any(agrees) {
            self.pending.push(tie);
            let excess = self.pending.len().saturating_sub(4);
            self.pending.drain(..excess);
            return None;
        }
        let ties_before = history.loops.len();
        if !known {
            let agreeing: Vec<Tie> = self.pending.drain(..).filter(|other| agrees(other)).collect();
            history.loops.extend(agreeing);
        }
        history.loops.push(tie);
        history.measure(poses);
        if known && off.position().norm() < 0.05 && off.theta.abs() < 0.01 {
            return None;
        }
        let ties = history.ties(poses);
        let bent = solve(poses.to_vec(), &ties);
        let fits = |bent: &Vec<Pose2>| {
            history.loops.iter().all(|tie| {
                let residual = tie.residual(bent[tie.from as usize], bent[tie.to as usize]);
                residual.xy().norm() < 1.0 && residual.z.abs() < 0.2
            })
        };
        let Some(bent) = bent.filter(fits) else {
            history.loops.truncate(ties_before);
            return None;
        };
        let farthest = bent.iter().zip(poses).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        Some(Closing { poses: bent, farthest })
    }
}

/// From the pose that is nearest to where the last one was found.
fn tie(config: &ParticleConfig, poses: &[Pose2], which: &[usize], found: &Found) -> Tie {
    let metre = config.map.resolution;
    let pose = Pose2 { x: found.pose.x * metre, y: found.pose.y * metre, ..found.pose };
    let nearest =
        which.iter().copied().min_by(|&a, &b| poses[a].distance(&pose).total_cmp(&poses[b].distance(&pose)));
    let from = nearest.expect("invariant: a map is drawn from scans");
    let (s, c) = pose.theta.sin_cos();
    let turn = Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    let scale = Matrix3::from_diagonal(&Vector3::new(metre, metre, 1.0));
    let weak = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1.0));
    let covariance = (found.information + weak).try_inverse().expect("invariant: a positive matrix");
    let floor = Matrix3::from_diagonal(&Vector3::new(0.03 * 0.03, 0.03 * 0.03, 0.005 * 0.005));
    Tie {
        from: from as u32,
        to: poses.len() as u32 - 1,
        from_to: poses[from].inverse() * pose,
        covariance: turn * scale * covariance * scale * turn.transpose() + floor,
    }
}
