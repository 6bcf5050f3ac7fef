//! A search over straight moves and turns in place for a polygonal footprint, each motion swept without contact.
//!
//! Problem: the circumscribed disc of a long robot does not fit through a gap that the robot passes at the right heading. Idea: a joint
//! search over cell and heading. A motion is a step along the heading or a turn to the next of 16 headings, and is checked exactly. The
//! heuristic is the [`CoarseHeuristic`] of the inscribed disc. Complete on its lattice. Cost: O(16 cells reached).

use crate::geometry::bearing;
use crate::polygon::robot_shape::RobotShape;
use crate::search::bucket_queue::{BucketQueue, Entry};
use crate::search::coarse_heuristic::CoarseHeuristic;
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::lattice::SIDE;
use crate::search::lattice::{STEPS, length};
use trundle_core::{Pose2, Vector2};

/// Number of headings. Source: the steps of the lattice, `STEPS`.
const HEADING_COUNT: usize = 16;
/// The steps of the lattice by rising direction, counter-clockwise from +x.
const BY_HEADING: [usize; HEADING_COUNT] = [0, 8, 4, 12, 2, 14, 6, 10, 1, 11, 7, 15, 3, 13, 5, 9];
/// Cost of a turn to the next heading, in lattice units. A lower one makes paths with many turns. Source: ours.
const TURN_COST: u32 = 2 * SIDE;
/// Cost of a state that the search has not reached.
const UNREACHED: u32 = u32::MAX;
/// Mark of states reached from the start directly.
const SEED_MARK: u8 = 3;

/// The search with its buffers, reused from plan to plan.
#[derive(Debug, Default)]
pub(crate) struct LatticePlanner {
    cost: Vec<u32>,
    /// Motion by which each state was reached. 0: a step; 1, 2: a turn to the left, to the right; [`SEED_MARK`].
    arrival: Vec<u8>,
    queue: BucketQueue,
    heuristic: CoarseHeuristic,
}

impl LatticePlanner {
    /// Poses from `start` to `goal`, each reached from the previous one by a turn in place or a straight move along its heading; or the
    /// reachable point nearest to the goal. Both ends must be free.
    pub(crate) fn run(
        &mut self,
        space: &ConfigurationSpace<'_>,
        shape: &RobotShape,
        start: Pose2,
        goal: Pose2,
    ) -> Result<Vec<Pose2>, Vector2> {
        let inside = |pose: Pose2| space.field.geometry().cell_at(pose.position()).is_some();
        if !inside(start) || !inside(goal) {
            return Err(start.position());
        }
        // A robot that touches a wall moves straight along it or not at all.
        if let Some(straight) = link(space, shape, start, goal) {
            return Ok(std::iter::once(start).chain(straight).collect());
        }
        // Between two walls few turns are free: the lattice is then entered farther on, and left as far before the goal.
        let (away, first) =
            lattice_entry(space, shape, start, 1.0, |pose, state| link(space, shape, pose, state).is_some());
        let (before, last) =
            lattice_entry(space, shape, goal, -1.0, |pose, state| link(space, shape, state, pose).is_some());
        self.heuristic.prepare(space, first[0], last[0]);
        self.cost.clear();
        self.cost.resize(space.field.geometry().len() * HEADING_COUNT, UNREACHED);
        self.arrival.clear();
        self.arrival.resize(self.cost.len(), SEED_MARK);
        self.queue.reset(self.heuristic.ahead(first[0]), 1 << 16);
        for place in first {
            self.seed(space, shape, away, place);
        }
        let (mut nearest, mut min) = (start.position(), f64::INFINITY);
        while let Some((_, Entry { cell: state, cost })) = self.queue.pop() {
            let state = state as usize;
            if cost > self.cost[state] {
                continue;
            }
            let pose = pose_of(space, state);
            let off = (pose.position() - goal.position()).norm();
            if off < min {
                (min, nearest) = (off, pose.position());
            }
            if last.contains(&space.place(state / HEADING_COUNT))
                && let Some(arrival) = link(space, shape, pose, before)
            {
                let mut poses = vec![start, away];
                poses.extend(self.follow_back(space, state));
                poses.extend(arrival);
                poses.push(goal);
                poses.dedup();
                return Ok(poses);
            }
            self.spread(space, shape, state, pose);
        }
        Err(nearest)
    }

    /// Adds the states reachable from the start by a turn, a straight move and a turn.
    fn seed(&mut self, space: &ConfigurationSpace<'_>, shape: &RobotShape, start: Pose2, place: (u32, u32)) {
        let cell = place.1 as usize * space.field.geometry().width + place.0 as usize;
        for heading in 0..HEADING_COUNT {
            let state = cell * HEADING_COUNT + heading;
            if link(space, shape, start, pose_of(space, state)).is_some() {
                let path =
                    (space.point_of(cell) - start.position()).norm() / space.field.geometry().resolution;
                self.reach(space, state, (path * f64::from(SIDE)) as u32, SEED_MARK);
            }
        }
    }

    fn reach(&mut self, space: &ConfigurationSpace<'_>, state: usize, cost: u32, arrival: u8) {
        (self.cost[state], self.arrival[state]) = (cost, arrival);
        let key = cost.saturating_add(self.heuristic.ahead(space.place(state / HEADING_COUNT)));
        self.queue.push_near(key, Entry { cell: state as u32, cost });
    }

    fn spread(&mut self, space: &ConfigurationSpace<'_>, shape: &RobotShape, state: usize, pose: Pose2) {
        let (cell, heading) = (state / HEADING_COUNT, state % HEADING_COUNT);
        let so_far = self.cost[state];
        let step = BY_HEADING[heading];
        if let Some(to) = stepped(space, cell, STEPS[step]) {
            let price = u32::from(space.cell_price(cell)) + u32::from(space.cell_price(to));
            let cost = so_far.saturating_add((length(step) * price) >> 9);
            let target = to * HEADING_COUNT + heading;
            let by = space.point_of(to) - space.point_of(cell);
            if cost < self.cost[target] && shape.may_move(space.field, pose, by, 0.0) {
                self.reach(space, target, cost, 0);
            }
        }
        for (arrival, next) in
            [(1, (heading + 1) % HEADING_COUNT), (2, (heading + HEADING_COUNT - 1) % HEADING_COUNT)]
        {
            let target = cell * HEADING_COUNT + next;
            let cost = so_far.saturating_add(TURN_COST);
            let turn = trundle_core::difference_of_angles(angle(next), angle(heading));
            if cost < self.cost[target] && shape.may_move(space.field, pose, Vector2::zeros(), turn) {
                self.reach(space, target, cost, arrival);
            }
        }
    }

    fn follow_back(&self, space: &ConfigurationSpace<'_>, last: usize) -> Vec<Pose2> {
        let width = space.field.geometry().width as i64;
        let mut poses = vec![pose_of(space, last)];
        let mut state = last;
        while self.arrival[state] != SEED_MARK {
            let (cell, heading) = (state / HEADING_COUNT, state % HEADING_COUNT);
            state = match self.arrival[state] {
                1 => cell * HEADING_COUNT + (heading + HEADING_COUNT - 1) % HEADING_COUNT,
                2 => cell * HEADING_COUNT + (heading + 1) % HEADING_COUNT,
                _ => {
                    let (dx, dy) = STEPS[BY_HEADING[heading]];
                    (cell as i64 - i64::from(dy) * width - i64::from(dx)) as usize * HEADING_COUNT + heading
                }
            };
            poses.push(pose_of(space, state));
        }
        poses.reverse();
        poses
    }
}

/// Shortens a pose sequence: from each pose, the farthest later one that a turn, a straight move and a turn reach without contact.
pub(crate) fn shortened(space: &ConfigurationSpace<'_>, shape: &RobotShape, poses: &[Pose2]) -> Vec<Pose2> {
    let mut kept = vec![poses[0]];
    let mut from = 0;
    while from + 1 < poses.len() {
        let here = kept[kept.len() - 1];
        let mut reach = poses.len() - 1 - from;
        loop {
            // A single step was checked by the search.
            let next = poses[from + reach];
            if let Some(linked) = link(space, shape, here, next) {
                kept.extend(linked);
                break;
            }
            if reach == 1 {
                kept.push(next);
                break;
            }
            reach /= 2;
        }
        from += reach;
    }
    kept
}

/// The poses after `from` on a link to `to` by a turn, a straight move and a turn, if that is free.
pub(crate) fn link(
    space: &ConfigurationSpace<'_>,
    shape: &RobotShape,
    from: Pose2,
    to: Pose2,
) -> Option<Vec<Pose2>> {
    const SAME_PLACE: f64 = 1e-6;
    let by = to.position() - from.position();
    let mut poses = Vec::new();
    let mut heading = from.theta;
    if by.norm() > SAME_PLACE {
        heading = bearing(by);
        shape.turn(space.field, from, heading)?;
        let turned = Pose2::new(from.x, from.y, heading);
        if !shape.may_move(space.field, turned, by, 0.0) {
            return None;
        }
        poses.extend([turned, Pose2::new(to.x, to.y, heading)]);
    }
    shape.turn(space.field, Pose2::new(to.x, to.y, heading), to.theta)?;
    poses.push(to);
    Some(poses)
}

/// Distance ahead of a pose within which the lattice is entered, m. Source: ours.
const ENTRY_DISTANCE_M: f64 = 1.5;
/// Step of the search for the entry, m. Source: ours.
const ENTRY_STEP_M: f64 = 0.05;

/// The entry into the lattice from `pose`, or the exit to it (`side` -1: behind it). The result is the cells that `links` reaches from the
/// pose or from a pose straight ahead, and that pose.
fn lattice_entry(
    space: &ConfigurationSpace<'_>,
    shape: &RobotShape,
    pose: Pose2,
    side: f64,
    links: impl Fn(Pose2, Pose2) -> bool,
) -> (Pose2, Vec<(u32, u32)>) {
    let width = space.field.geometry().width;
    let states = |place: &(u32, u32)| {
        let cell = place.1 as usize * width + place.0 as usize;
        (0..HEADING_COUNT).map(move |heading| cell * HEADING_COUNT + heading)
    };
    let opens = |from: Pose2, places: &[(u32, u32)]| {
        places.iter().flat_map(states).any(|state| links(from, pose_of(space, state)))
    };
    let mut is_free = true;
    for k in 0..=(ENTRY_DISTANCE_M / ENTRY_STEP_M) as usize {
        let by = pose.direction() * (side * k as f64 * ENTRY_STEP_M);
        let there = Pose2::new(pose.x + by.x, pose.y + by.y, pose.theta);
        let Some(places) = near(space, there.position()) else { break };
        if opens(pose, &places) {
            return (pose, places);
        }
        is_free = is_free && shape.may_move(space.field, pose, by, 0.0);
        if is_free && opens(there, &places) {
            return (there, places);
        }
    }
    (pose, near(space, pose.position()).unwrap_or_default())
}

/// The cells around a point, as columns and rows.
fn near(space: &ConfigurationSpace<'_>, point: Vector2) -> Option<Vec<(u32, u32)>> {
    let geometry = space.field.geometry();
    let middle = geometry.cell_at(point)?;
    let mut places = vec![(middle.col as u32, middle.row as u32)];
    for (dx, dy) in &STEPS[..8] {
        let (c, r) = (middle.col as i64 + i64::from(*dx), middle.row as i64 + i64::from(*dy));
        if c >= 0 && r >= 0 && c < geometry.width as i64 && r < geometry.height as i64 {
            places.push((c as u32, r as u32));
        }
    }
    Some(places)
}

fn stepped(space: &ConfigurationSpace<'_>, cell: usize, (dx, dy): (i32, i32)) -> Option<usize> {
    let geometry = space.field.geometry();
    let (col, row) = space.place(cell);
    let (c, r) = (col as i32 + dx, row as i32 + dy);
    let inside = c >= 0 && r >= 0 && c < geometry.width as i32 && r < geometry.height as i32;
    inside.then(|| r as usize * geometry.width + c as usize)
}

fn angle(heading: usize) -> f64 {
    let (dx, dy) = STEPS[BY_HEADING[heading]];
    f64::from(dy).atan2(f64::from(dx))
}

fn pose_of(space: &ConfigurationSpace<'_>, state: usize) -> Pose2 {
    let at = space.point_of(state / HEADING_COUNT);
    Pose2::new(at.x, at.y, angle(state % HEADING_COUNT))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_rise_around_the_circle() {
        for heading in 0..HEADING_COUNT {
            let turn =
                trundle_core::difference_of_angles(angle((heading + 1) % HEADING_COUNT), angle(heading));
            assert!(turn > 0.3 && turn < 0.5, "{heading}: {turn}");
        }
    }
}
