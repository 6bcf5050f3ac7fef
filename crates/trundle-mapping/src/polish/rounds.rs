//! Rounds of matching and solving.

use crate::loop_closing::scan_history::ScanHistory;
use crate::particle_config::ParticleConfig;
use crate::polish::overlap::pairs;
use crate::polish::pair::{MatchModel, PairEquations};
use crate::polish::surface_scan::SurfaceScan;
use crate::pose_graph::{Constraint, PoseEquations};
use crate::scan_match::scan_points::ScanPoints;
use rayon::prelude::*;
use trundle_core::{Pose2, Vector2};

/// Scale of the robust kernel in each round \[m\]. Source: ours: it begins at the reach of the filter's field of obstacles, and ends near
/// three sigmas of a laser's range, with two steps at each scale.
const KERNEL_SCALES_M: [f64; 6] = [0.2, 0.2, 0.1, 0.1, 0.06, 0.06];
/// Smallest scale of a hit's kernel \[sigmas\]. Source: ours.
const MIN_KERNEL_SCALE_SIGMAS: f64 = 3.0;
/// Minimum number of matched hits of a pair, of both scans. Source: ours.
const MIN_MATCHED_HITS: f64 = 30.0;
/// Largest ratio of contradicted to matched hits of a pair \[1\]. Beyond it the scans do not observe the same surfaces. Source: ours, moved
/// furniture in a drawn hall contradicts up to 0.28.
const MAX_CONTRADICTED_RATIO: f64 = 0.3;
/// Fraction of the information of the filter's steps and loops that counts \[1\]. They come from the same scans as the pairs, and have a
/// say only in directions that no pair determines. Source: ours.
const FILTER_INFORMATION_SHARE: f64 = 0.1;

/// Largest number of blocks of the factor, 72 bytes each: 72 MB. Source: ours.
const MAX_BLOCKS: usize = 1_000_000;

/// A pair of scans: numbers of the later and of the earlier one.
type Pair = (usize, usize);
/// The equations of the later scan on the earlier one, and of the earlier on the later.
type BothEquations = [PairEquations; 2];

/// The poses (m, rad) near `poses` at which all stored scans agree best; the first pose is fixed.
///
/// `None` if fewer than two scans are stored, the graph is too large or does not determine all poses, the scans agree no better than before,
/// or `goes_on` ends it between two rounds. The same bits on any number of threads.
pub(crate) fn polished(
    config: &ParticleConfig,
    history: &ScanHistory,
    poses: &[Pose2],
    goes_on: &dyn Fn() -> bool,
) -> Option<Vec<Pose2>> {
    if poses.len() < 2 {
        return None;
    }
    let scans = surface_scans(config, history);
    let constraints = history.constraints(poses);
    let mut polished = poses.to_vec();
    for scale in KERNEL_SCALES_M {
        if !goes_on() {
            return None;
        }
        step(&scans, &constraints, &mut polished, &model(config, scale))?;
    }
    let last = model(config, *KERNEL_SCALES_M.last()?);
    let pairs = pairs(&centres(&scans, &polished));
    (agreement(&scans, poses, &pairs, &last) < agreement(&scans, &polished, &pairs, &last))
        .then_some(polished)
}

fn model(config: &ParticleConfig, scale: f64) -> MatchModel {
    MatchModel {
        scale,
        min_scale_sigmas: MIN_KERNEL_SCALE_SIGMAS,
        correlation: config.correlation,
        degenerate_below: config.degenerate_below,
    }
}

fn surface_scans(config: &ParticleConfig, history: &ScanHistory) -> Vec<SurfaceScan> {
    let unpacked = |points: &mut ScanPoints, k: usize| {
        history.scans[k].unpack_into(config, points);
        SurfaceScan::new(points.origin(config), &points.hits(config))
    };
    (0..history.scans.len()).into_par_iter().map_init(ScanPoints::default, unpacked).collect()
}

/// Centres of the views of the scans, map frame, m.
fn centres(scans: &[SurfaceScan], poses: &[Pose2]) -> Vec<Vector2> {
    scans.iter().zip(poses).map(|(scan, pose)| pose.transform(scan.centre)).collect()
}

/// Matches all pairs at `poses`, and takes one Gauss-Newton step. `None` if a pose is not determined.
fn step(
    scans: &[SurfaceScan],
    constraints: &[Constraint],
    poses: &mut [Pose2],
    model: &MatchModel,
) -> Option<()> {
    let mut pairs = pairs(&centres(scans, poses));
    let matches = matches(scans, poses, &pairs, model);
    let both = pairs.len();
    pairs.extend(constraints.iter().map(Constraint::poses));
    let mut equations = PoseEquations::new_within(poses.len(), &pairs, MAX_BLOCKS)?;
    for (&(later, earlier), [there, back]) in pairs[..both].iter().zip(&matches) {
        if is_consistent(there, back) {
            let earlier_from_later = poses[earlier].inverse() * poses[later];
            add_pair(&mut equations, (later, earlier), earlier_from_later, there);
            add_pair(&mut equations, (earlier, later), earlier_from_later.inverse(), back);
        }
    }
    for constraint in constraints {
        let information = constraint.information() * FILTER_INFORMATION_SHARE;
        equations.add_constraint(poses, constraint, &information);
    }
    let steps = equations.solve()?;
    poses.iter_mut().zip(steps).for_each(|(pose, step)| *pose = *pose * Pose2::exp(*step));
    Some(())
}

/// Adds the match of the hits of the first scan of `pair` with the second.
fn add_pair(equations: &mut PoseEquations, pair: Pair, second_from_first: Pose2, matched: &PairEquations) {
    equations.add_relative(pair, second_from_first, &matched.information, &matched.rhs);
}

fn matches(scans: &[SurfaceScan], poses: &[Pose2], pairs: &[Pair], model: &MatchModel) -> Vec<BothEquations> {
    let equations = |&(later, earlier): &Pair| {
        let earlier_from_later = poses[earlier].inverse() * poses[later];
        [
            PairEquations::new(&scans[later], &scans[earlier], earlier_from_later, model),
            PairEquations::new(&scans[earlier], &scans[later], earlier_from_later.inverse(), model),
        ]
    };
    pairs.par_iter().map(equations).collect()
}

fn is_consistent(there: &PairEquations, back: &PairEquations) -> bool {
    let matched = there.matched + back.matched;
    let contradicted = there.contradicted + back.contradicted;
    matched >= MIN_MATCHED_HITS && contradicted <= MAX_CONTRADICTED_RATIO * matched
}

/// Number of matched hits of all pairs, less the contradicted ones.
fn agreement(scans: &[SurfaceScan], poses: &[Pose2], pairs: &[Pair], model: &MatchModel) -> f64 {
    let all = matches(scans, poses, pairs, model);
    all.iter().flatten().map(|part| part.matched - part.contradicted).sum()
}
