//! Planning among very many points.
//!
//! Problem: every question about contact looks at every point near. Idea: plan among a few of them, those that stand out
//! farthest, then ask all of them about the manoeuvre's own motions; what is in the way of one is added with its neighbours,
//! and it is planned again. Fewer obstacles forbid less: what is impossible among a few is impossible among all, and a bound
//! among a few is a bound. Exact, and mostly done after a few rounds.

use crate::geometry::Hull;
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::planner::Plan;
use crate::scene::{Blocker, Scene};
use crate::space::Space;
use trundle_core::{Footprint, Pose2};

/// More points than this are planned among a few at first.
pub const MANY_POINTS: usize = 1500;
/// Side of the squares of which the outermost points are taken at first, m.
const SQUARE: f64 = 0.1;
/// Points within this of one that was in the way are looked at too, m, ...
const NEIGHBOURS: f64 = 0.04;
/// ... in squares of this side, m.
const FINE_SQUARE: f64 = 0.02;
/// After so many rounds it is planned among all that can be touched first.
const ROUNDS: usize = 12;

/// Plans with `plan` among more and more points of `all`, until none is in the way.
pub fn plan_in_cloud(
    footprint: &Footprint,
    all: &Scene,
    margin: f64,
    mut plan: impl FnMut(&Scene) -> Plan,
) -> Plan {
    let mut few = all.sparse(SQUARE);
    for _ in 0..ROUNDS {
        let found = plan(&few);
        let Plan::Found(solution) = &found else { return found };
        let blockers = in_the_way(&solution.manoeuvre, &mut Space::new(footprint, margin, all));
        if blockers.is_empty() {
            return found;
        }
        few = few.with_points(all.points_near(&blockers, NEIGHBOURS, FINE_SQUARE));
    }
    plan(&all.thinned(&Hull::new(footprint, margin)))
}

/// What forbids the motions of a manoeuvre.
fn in_the_way(manoeuvre: &Manoeuvre, space: &mut Space<'_>) -> Vec<Blocker> {
    let mut found = Vec::new();
    for step in manoeuvre.steps() {
        let (room, by, way) = free(&step.from, step.motion, space);
        if room + 1e-9 < way {
            found.extend(by);
        }
    }
    found
}

/// How far a motion is free, what ends it, and how far it goes.
fn free(from: &Pose2, motion: Motion, space: &mut Space<'_>) -> (f64, Option<Blocker>, f64) {
    let way = motion.amount().abs();
    match motion {
        Motion::Turn(angle) => {
            let turn = space.turn(from);
            if angle > 0.0 { (turn.left, turn.left_by, way) } else { (turn.right, turn.right_by, way) }
        }
        Motion::Drive(signed) => {
            let drive = space.drive(from, way + 0.01);
            if signed > 0.0 {
                (drive.ahead, drive.ahead_by, way)
            } else {
                (drive.behind, drive.behind_by, way)
            }
        }
    }
}
