//! The transform between two maps of one place.
//!
//! Problem: maps of different days or floors have frames of their own, any distance and any turn apart. Idea: correlative matching
//! \[Olson09\] of the whole pose space. At each of a lattice of poses, walls of the second map that lie on walls of the first one count for
//! the pose; walls of one map on free floor of the other count against it. The best candidates are refined on the full maps, and measured
//! in both directions. A pose is refused if too little agrees, or if a second pose fits nearly as well. Cost: the lattice has steps of 0.2
//! m, larger for maps above about 50 m; its sums are additions of rows of 16-bit numbers.

mod agreement;
mod coarse_field;
mod coarse_search;
mod map_shape;
mod refinement;

pub use agreement::MapFit;

use agreement::measured;
use coarse_search::candidates;
use map_shape::MapShape;
use rayon::prelude::*;
use refinement::refined;
use trundle_core::{OccupancyGrid, Pose2, wrap_angle};

/// Part of the compared walls that agree, below which a pose does not fit. Source: ours.
pub const MIN_AGREEING_SHARE: f64 = 0.6;
/// Length of the agreeing walls, both maps together, below which a pose does not fit \[m\]. Source: ours.
pub const MIN_AGREEING_M: f64 = 4.0;
/// Score of a second pose, as a part of the best one's, from which the transform is ambiguous. Source: ours.
const MAX_RIVAL_SHARE: f64 = 0.85;
/// Distance of two poses, at the middle of the second map, above which they are different \[m\]. Source: ours.
const MIN_APART_M: f64 = 0.5;
/// Turn between two poses above which they are different \[rad\]. Source: ours, 10 deg.
const MIN_APART_RAD: f64 = 0.1745;

/// The transform between two maps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapMatch {
    /// The best pose.
    pub best: MapFit,
    /// The best of the poses that differ from it; `None` without another candidate.
    pub rival: Option<MapFit>,
}

/// The reason for the absence of a transform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MatchFailure {
    /// The first (0) or second (1) map has no wall beside free floor.
    NoWall(usize),
    /// No pose fits; the best one.
    NothingFits(MapFit),
    /// Several poses fit.
    Ambiguous(MapMatch),
}

/// Finds the pose of the second map's frame in the first one's, by a search of all poses at which the maps can overlap.
///
/// # Errors
/// When a map has no wall, no pose fits, or a second pose fits nearly as well.
pub fn match_maps(first: &OccupancyGrid, second: &OccupancyGrid) -> Result<MapMatch, MatchFailure> {
    let shape = |grid, which| MapShape::new(grid).ok_or(MatchFailure::NoWall(which));
    let (first, second) = (shape(first, 0)?, shape(second, 1)?);
    let found = candidates(&first, &second);
    let mut fits: Vec<MapFit> =
        found.par_iter().map(|pose| measured(&first, &second, refined(&first, &second, *pose))).collect();
    fits.sort_by(|a, b| b.score_m().total_cmp(&a.score_m()));
    let best = *fits.first().ok_or(MatchFailure::NoWall(1))?;
    if best.agreeing_share() < MIN_AGREEING_SHARE || best.agreeing_m < MIN_AGREEING_M {
        return Err(MatchFailure::NothingFits(best));
    }
    let is_apart = |fit: &&MapFit| apart(&second, fit.first_from_second, best.first_from_second);
    let rival = fits.iter().find(is_apart).copied();
    let found = MapMatch { best, rival };
    let rival_m = rival.map_or(0.0, |rival| rival.score_m());
    if rival_m > MAX_RIVAL_SHARE * best.score_m() { Err(MatchFailure::Ambiguous(found)) } else { Ok(found) }
}

/// Measures a given pose.
///
/// # Errors
/// When a map has no wall.
pub fn fit_at(
    first: &OccupancyGrid,
    second: &OccupancyGrid,
    first_from_second: Pose2,
) -> Result<MapFit, MatchFailure> {
    let shape = |grid, which| MapShape::new(grid).ok_or(MatchFailure::NoWall(which));
    Ok(measured(&shape(first, 0)?, &shape(second, 1)?, first_from_second))
}

/// Whether two poses place the second map differently.
fn apart(second: &MapShape, a: Pose2, b: Pose2) -> bool {
    (a.transform(second.middle) - b.transform(second.middle)).norm() > MIN_APART_M
        || wrap_angle(a.theta - b.theta).abs() > MIN_APART_RAD
}

#[cfg(test)]
mod tests;
