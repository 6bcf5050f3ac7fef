//! Proofs of impossibility, compared with an exhaustive search over connected poses.

use crate::contact::{distance, footprint, obstacle, sides};
use crate::shapes::ends;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_docking::{Certificate, DockingConfig, DockingPlan, DockingPlanner, Obstacle, ObstacleScene};

/// Proofs that are put to the test.
const PROOFS: usize = 6;
/// Distance between neighbouring poses, m, and number of headings.
const STEP: f64 = 0.04;
const HEADINGS: i32 = 48;

/// Poses on a lattice around the start, each with enough clearance for a free step to the next.
struct Lattice<'a> {
    footprint: &'a Footprint,
    pieces: &'a [(Vector2, Vector2)],
    start: Pose2,
    /// Middle and half side of the square that was proven.
    square: (Vector2, f64),
}

impl Lattice<'_> {
    fn pose(&self, (x, y, turn): (i32, i32, i32)) -> Pose2 {
        let p = self.start.position() + Vector2::new(f64::from(x), f64::from(y)) * STEP;
        Pose2::new(p.x, p.y, self.start.theta + f64::from(turn) * TAU / f64::from(HEADINGS))
    }

    fn is_free(&self, pose: &Pose2) -> bool {
        let (middle, half) = self.square;
        // Half a step: the largest distance of a pose from the nearest lattice pose.
        let moves = 0.5 * STEP.max(self.footprint.circumscribed_radius() * TAU / f64::from(HEADINGS));
        (pose.position() - middle).amax() <= half
            && distance(self.footprint, pose, self.pieces) > moves + 1e-3
    }

    /// Whether poses that hang together lead from the start to the goal.
    fn leads_to(&self, goal: &Pose2) -> bool {
        let seen = self.start.inverse() * *goal;
        let off = goal.position() - self.start.position();
        let round = |v: f64, by: f64| (v / by).round() as i32;
        let last = (
            round(off.x, STEP),
            round(off.y, STEP),
            round(seen.theta, TAU / f64::from(HEADINGS)).rem_euclid(HEADINGS),
        );
        // The motion from the goal to its node: along x and y and a turn, each less than half a step.
        if !self.is_free(goal) || !self.is_free(&self.pose(last)) || !self.is_free(&self.start) {
            return false;
        }
        let (mut known, mut open) = (BTreeSet::from([(0, 0, 0)]), vec![(0, 0, 0)]);
        while let Some(node) = open.pop() {
            if node == last {
                return true;
            }
            let (x, y, t) = node;
            let turned = |by: i32| (x, y, (t + by).rem_euclid(HEADINGS));
            for next in [(x + 1, y, t), (x - 1, y, t), (x, y + 1, t), (x, y - 1, t), turned(1), turned(-1)] {
                if known.insert(next) && self.is_free(&self.pose(next)) {
                    open.push(next);
                }
            }
        }
        false
    }
}

/// A goal with a proof of impossibility is not reachable over connected poses; a goal with a manoeuvre often is.
#[test]
fn a_goal_proven_impossible_is_not_reached_by_brute_force() {
    let mut rng = ChaCha8Rng::seed_from_u64(33);
    let mut config = DockingConfig::default();
    config.reach = 0.2;
    config.max_work = 2_000_000;
    config.bound_boxes = 0;
    let planner = DockingPlanner::new(config).unwrap();
    let (mut proofs, mut found, mut reached) = (0, 0, 0);
    while proofs < PROOFS {
        let footprint = footprint(&mut rng);
        let obstacles: Vec<Obstacle> = (0..rng.random_range(4..16)).map(|_| obstacle(&mut rng)).collect();
        let (scene, pieces) = (ObstacleScene::new(&obstacles).unwrap(), sides(&obstacles));
        let free = |pose: &Pose2| scene.clearance(&footprint, pose, 0.03).is_none();
        let Some((start, goal)) = ends(&mut rng, free) else { continue };
        let middle = (start.position() + goal.position()) / 2.0;
        let lattice = |within: f64| {
            let square = (middle, within + start.distance(&goal) / 2.0);
            Lattice { footprint: &footprint, pieces: &pieces, start, square }
        };
        match planner.plan(&footprint, &scene, start, goal).unwrap() {
            DockingPlan::Impossible(none) if none.certificate == Certificate::Never => {
                proofs += 1;
                assert!(
                    !lattice(none.within).leads_to(&goal),
                    "proof {proofs}: {none:?} {footprint:?} {obstacles:?}"
                );
            }
            DockingPlan::Found(_) if found < PROOFS => {
                (found, reached) = (found + 1, reached + usize::from(lattice(0.4).leads_to(&goal)));
            }
            _ => {}
        }
    }
    eprintln!("{proofs} proofs hold; of {found} that were found, brute force reaches {reached}");
    assert!(3 * reached > found, "brute force sees too missing_heading: {reached} of {found}");
}
