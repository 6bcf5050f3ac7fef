//! Agreement of two maps at a pose, measured in both directions.

use super::map_shape::MapShape;
use trundle_core::{Cell, Pose2};

/// Distance from the nearest wall of the other map up to which a wall agrees \[cells\]. Source: ours.
const AGREEING_CELLS: f64 = 1.0;
/// Distance from the nearest wall of the other map from which a wall on free floor contradicts \[cells\]. Source: ours.
const CONTRADICTING_CELLS: f64 = 2.0;

/// Weight of a metre that contradicts against a metre that agrees. Source: ours; wrong poses in repeated rooms contradict, true ones hardly
/// do.
const CONTRADICTION_WEIGHT: f64 = 3.0;

/// Agreement of two maps at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapFit {
    /// The pose of the second map's frame in the first one's.
    pub first_from_second: Pose2,
    /// Length of the walls of both maps that lie on walls of the other map \[m\].
    pub agreeing_m: f64,
    /// Length of the walls of both maps that lie on free floor of the other map \[m\].
    pub contradicting_m: f64,
}

impl MapFit {
    /// Part of the compared walls that agree, 0 to 1.
    #[must_use]
    pub fn agreeing_share(&self) -> f64 {
        let all = self.agreeing_m + self.contradicting_m;
        if all > 0.0 { self.agreeing_m / all } else { 0.0 }
    }

    /// What agrees less three times what contradicts \[m\].
    #[must_use]
    pub fn score_m(&self) -> f64 {
        self.agreeing_m - CONTRADICTION_WEIGHT * self.contradicting_m
    }
}

/// The agreement at a pose.
pub(super) fn measured(first: &MapShape, second: &MapShape, first_from_second: Pose2) -> MapFit {
    let (a, b) = one_way(second, first, first_from_second);
    let (c, d) = one_way(first, second, first_from_second.inverse());
    MapFit { first_from_second, agreeing_m: a + c, contradicting_m: b + d }
}

/// Agreeing and contradicting length of the walls of `from` in the map `to`.
fn one_way(from: &MapShape, to: &MapShape, to_from_from: Pose2) -> (f64, f64) {
    let cell = from.resolution().max(to.resolution());
    let (mut agreeing, mut contradicting) = (0_usize, 0_usize);
    for point in &from.surface {
        let at = to_from_from.transform(*point);
        let Some(distance) = to.distance(at) else { continue };
        if distance <= AGREEING_CELLS * cell {
            agreeing += 1;
        } else if distance >= CONTRADICTING_CELLS * cell && to.at(at) == Cell::Free {
            contradicting += 1;
        }
    }
    (agreeing as f64 * from.resolution(), contradicting as f64 * from.resolution())
}
