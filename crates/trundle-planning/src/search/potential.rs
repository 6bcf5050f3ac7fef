//! The artificial potential field \[Ge00, Li18\], and gradient descent on it.
//!
//! Problem: waypoints from a pose to a goal past obstacles. Idea: a quadratic potential attracts to the goal, and obstacles repel within
//! rho_0. The repulsion fades with the distance to the goal (n = 2), which makes the goal the global minimum. The robot follows the force
//! in steps of one length. Local minima remain (U shapes); they are detected and reported. Cost: O(steps).
//! | paper | here | unit |
//! |---|---|---|
//! | q | `point` | m |
//! | rho_g | distance to the goal | m |
//! | rho_o | distance to the nearest obstacle minus the robot's radius | m |
//! | epsilon, eta | `attraction`, `repulsion` | 1 |
//! | rho_0 | `reach` | m |

use crate::search::configuration_space::ConfigurationSpace;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Vector2, require_in, require_positive};
use trundle_grid::DistanceField;

/// Method that finds the waypoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PotentialKind {
    /// Gradient descent on the potential of \[Ge00\]; if the descent is trapped, the geodesic search takes over.
    Printed,
    /// Geodesic search: attraction by the geodesic distance, repulsion by higher costs near obstacles. The field has no local minima.
    Geodesic,
}

/// Parameters of the potential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct PotentialConfig {
    /// Search method for waypoints. Default geodesic: complete, with shorter paths.
    pub kind: PotentialKind,
    /// Gain epsilon of the attraction by the goal, above 0, for `printed`. Default 1 (ours).
    pub attraction: f64,
    /// Gain eta of the repulsion by obstacles, above 0, for `printed`. Default 0.001 (ours): 5 m from the goal the forces balance 0.15 m
    /// from a wall.
    pub repulsion: f64,
    /// Distance rho_0 within which obstacles repel, m, above 0, to 100, for `printed`. Default 0.5 (ours).
    pub reach: f64,
    /// Number of steps without progress after which the descent counts as trapped, 1 to 100000, for `printed`. Default 100 (ours).
    pub patience: usize,
}

impl Default for PotentialConfig {
    fn default() -> Self {
        Self { kind: PotentialKind::Geodesic, attraction: 1.0, repulsion: 0.001, reach: 0.5, patience: 100 }
    }
}

impl PotentialConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_positive("potential.attraction", self.attraction, "")?;
        require_positive("potential.repulsion", self.repulsion, "")?;
        require_in("potential.reach", self.reach, "m", 1e-3, 100.0)?;
        require_in("potential.patience", self.patience as f64, "steps", 1.0, 1e5)?;
        Ok(self)
    }
}

/// Result of a descent.
#[derive(Debug, Clone, PartialEq)]
pub enum PotentialOutcome {
    /// The path reached the goal; the dense path, start and goal included, map frame, m.
    Reached(Vec<Vector2>),
    /// The path ended in a local minimum, or at a wall.
    Trapped {
        /// Position, map frame, m.
        at: Vector2,
        /// The path so far.
        path: Vec<Vector2>,
    },
}

/// The potential over a distance field.
#[derive(Debug, Clone, Copy)]
pub struct PotentialField<'a> {
    field: &'a DistanceField,
    goal: Vector2,
    radius: f64,
    config: PotentialConfig,
}

/// Smallest clearance in the formulas, m: below it the force would overflow. Source: ours.
const MIN_FORMULA_CLEARANCE_M: f64 = 1e-3;

impl<'a> PotentialField<'a> {
    /// The potential that attracts a disc of `radius` m to `goal` (map frame, m).
    pub fn new(field: &'a DistanceField, goal: Vector2, radius: f64, config: PotentialConfig) -> Self {
        Self { field, goal, radius, config }
    }

    /// U = U_att + U_rep at a point.
    pub fn energy(&self, point: Vector2) -> f64 {
        let to_goal = (self.goal - point).norm();
        let push = self.push(point);
        let PotentialConfig { attraction, repulsion, .. } = self.config;
        0.5 * attraction * to_goal * to_goal + 0.5 * repulsion * push * push * to_goal * to_goal
    }

    /// F = -grad U = F_att + F_rep1 grad rho_o - F_rep2 grad rho_g at a point, n = 2.
    pub fn force(&self, point: Vector2) -> Vector2 {
        let off = self.goal - point;
        let to_goal = off.norm();
        let push = self.push(point);
        let PotentialConfig { attraction, repulsion, .. } = self.config;
        let clearance = self.clearance(point);
        // grad rho_g points away from the goal: F_rep2 attracts.
        let attractive = off * (attraction + repulsion * push * push);
        attractive
            + self.field.gradient(point) * (repulsion * push * to_goal * to_goal / (clearance * clearance))
    }

    /// 1 / rho_o - 1 / rho_0 within reach, else 0.
    fn push(&self, point: Vector2) -> f64 {
        (1.0 / self.clearance(point) - 1.0 / self.config.reach).max(0.0)
    }

    fn clearance(&self, point: Vector2) -> f64 {
        (self.field.distance(point) - self.radius).max(MIN_FORMULA_CLEARANCE_M)
    }

    /// Follows the force from `start` in steps of one cell's side, each free for the robot.
    pub(crate) fn descend(&self, space: &ConfigurationSpace<'_>, start: Vector2) -> PotentialOutcome {
        let step = self.field.geometry().resolution;
        let mut path = vec![start];
        let mut at = start;
        let mut best = (start - self.goal).norm();
        let mut waited = 0;
        while (at - self.goal).norm() > step || !space.connects(at, self.goal) {
            let force = self.force(at);
            let next = force.try_normalize(1e-12).and_then(|unit| free_step(space, at, unit * step));
            let Some(next) = next.filter(|_| waited < self.config.patience) else {
                return PotentialOutcome::Trapped { at, path };
            };
            at = next;
            path.push(at);
            let left = (at - self.goal).norm();
            waited += 1;
            if left < best - step / 2.0 {
                (best, waited) = (left, 0);
            }
        }
        path.push(self.goal);
        PotentialOutcome::Reached(path)
    }
}

/// The step, halved until it is free.
fn free_step(space: &ConfigurationSpace<'_>, from: Vector2, step: Vector2) -> Option<Vector2> {
    [1.0, 0.5, 0.25].into_iter().map(|share| from + step * share).find(|to| space.connects(from, *to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::clearance_cost::ClearanceCostConfig;
    use proptest::prelude::*;
    use trundle_core::OccupancyGrid;
    use trundle_grid::UnknownIs;

    const BOX: &str = "
        ####################
        #..................#
        #..................#
        #......######......#
        #...........#......#
        #...........#......#
        #...........#......#
        #......######......#
        #..................#
        #..................#
        ####################";

    fn outcome(from: (f64, f64), to: (f64, f64)) -> PotentialOutcome {
        let grid = OccupancyGrid::from_ascii(0.25, BOX).unwrap();
        let field = DistanceField::from_grid(&grid, UnknownIs::Free);
        let (start, goal) = (Vector2::new(from.0, from.1), Vector2::new(to.0, to.1));
        let space = ConfigurationSpace::new(&field, &grid, ClearanceCostConfig::default(), 0.17, start);
        PotentialField::new(&field, goal, 0.17, PotentialConfig::default()).descend(&space, start)
    }

    #[test]
    fn an_open_path_is_found_and_stays_free() {
        let outcome = outcome((0.6, 1.4), (2.2, 1.3));
        let PotentialOutcome::Reached(path) = outcome.clone() else { panic!("trapped: {outcome:?}") };
        assert_eq!((path[0], path[path.len() - 1]), (Vector2::new(0.6, 1.4), Vector2::new(2.2, 1.3)));
    }

    #[test]
    fn a_u_shape_traps_the_descent() {
        let PotentialOutcome::Trapped { at, path } = outcome((2.2, 1.4), (4.4, 1.4)) else { panic!("free") };
        assert!(at.x < 3.0 && path.len() < 200, "{at}");
    }

    proptest! {
        #[test]
        fn the_force_is_minus_the_gradient(x in 0.5..4.5, y in 0.5..2.3) {
            let grid = OccupancyGrid::from_ascii(0.25, BOX).unwrap();
            let field = DistanceField::from_grid(&grid, UnknownIs::Free);
            let config = PotentialConfig { repulsion: 0.1, ..Default::default() };
            let potential = PotentialField::new(&field, Vector2::new(4.2, 0.7), 0.1, config);
            let h = 1e-6;
            let kink = |p: f64| ((p / 0.25 - 0.5).rem_euclid(1.0) - 0.5).abs() > 0.5 - 1e-3;
            let room = field.distance(Vector2::new(x, y)) - 0.1;
            prop_assume!(!kink(x) && !kink(y) && room > 0.02 && (room - 0.5).abs() > 1e-3);
            let u = |dx: f64, dy: f64| potential.energy(Vector2::new(x + dx, y + dy));
            let numeric = -Vector2::new(u(h, 0.0) - u(-h, 0.0), u(0.0, h) - u(0.0, -h)) / (2.0 * h);
            let force = potential.force(Vector2::new(x, y));
            prop_assert!((numeric - force).norm() < 1e-4 * (1.0 + force.norm()), "{numeric} {force}");
        }
    }
}
