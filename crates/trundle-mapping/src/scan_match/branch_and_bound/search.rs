//! Branch-and-bound search for the best pose in a pyramid.

use super::lookup_budget::LookupBudget;
use super::pyramid::{PYRAMID_LEVELS, Pyramid};
use trundle_core::{Pose2, wrap_angle};

/// Points and search area.
#[derive(Debug, Clone)]
pub(crate) struct Query<'a> {
    /// Hits, base frame, cells.
    pub(crate) points: &'a [(f32, f32)],
    /// Centre of the search: cells of the map, rad.
    pub(crate) guess: Pose2,
    /// Reach of the search along x and y, cells.
    pub(crate) reach: (f64, f64),
    /// Reach of the search in heading, rad.
    pub(crate) turn_reach: f64,
    pub(crate) turn_step: f64,
    /// One sigma of the guess: cells, cells, rad; infinite if nothing is known.
    pub(crate) sigma: (f64, f64, f64),
    /// Gain of a point that fits, nats.
    pub(crate) gain: f64,
}

/// A pose that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FoundPose {
    pub(crate) pose: Pose2,
    /// Nats.
    pub(crate) score: f64,
    /// Mean likelihood of the points, 0 to 1.
    pub(crate) fit: f64,
}

impl FoundPose {
    /// Whether a pose is more than `apart` cells or `turned` rad away.
    pub(crate) fn is_apart(&self, pose: Pose2, apart: f64, turned: f64) -> bool {
        (self.pose.position() - pose.position()).norm() > apart
            || wrap_angle(self.pose.theta - pose.theta).abs() > turned
    }
}

/// A square of poses of one heading: `turn` steps, and the lowest shift in samples.
#[derive(Debug, Clone, Copy)]
struct Square {
    bound: f64,
    turn: i32,
    x: i32,
    y: i32,
}

struct Turned {
    /// Samples of the points at the lowest shift of the search.
    points: Vec<(i32, i32)>,
    theta: f64,
    penalty: f64,
}

impl Pyramid {
    /// The best pose of the lattice for a query, apart (cells, rad) from all of `known`, by branch and bound. `None` if all poses score
    /// less than `min`. A search that spends `budget` ends with the best pose so far.
    pub(crate) fn search(
        &self,
        query: &Query<'_>,
        known: &[FoundPose],
        (apart, min): ((f64, f64), f64),
        budget: &LookupBudget,
    ) -> Option<FoundPose> {
        let reach = ((query.reach.0 / 2.0).ceil() as i32, (query.reach.1 / 2.0).ceil() as i32);
        let turns = ((query.turn_reach / query.turn_step).ceil() as i32).max(0);
        let all: Vec<Turned> = (-turns..=turns).map(|turn| self.turned(query, turn, reach)).collect();
        let search = Search { pyramid: self, query, known, apart, reach, all, budget };
        let side = 1 << PYRAMID_LEVELS;
        let mut squares = Vec::new();
        for turn in 0..search.all.len() as i32 {
            for y in (0..=2 * reach.1).step_by(side) {
                for x in (0..=2 * reach.0).step_by(side) {
                    squares.push(search.square(PYRAMID_LEVELS, turn, x, y));
                }
            }
        }
        squares.retain(|s| s.bound > min);
        squares.sort_by(|a, b| b.bound.total_cmp(&a.bound).then((a.turn, a.y, a.x).cmp(&(b.turn, b.y, b.x))));
        let mut best = (min, None);
        for square in squares {
            search.descend(PYRAMID_LEVELS, square, &mut best);
        }
        best.1
    }

    fn turned(&self, query: &Query<'_>, turn: i32, reach: (i32, i32)) -> Turned {
        let off = f64::from(turn) * query.turn_step;
        let theta = query.guess.theta + off;
        let (s, c) = theta.sin_cos();
        let place = |&(x, y): &(f32, f32)| {
            let (x, y) = (f64::from(x), f64::from(y));
            let at = self.sample(query.guess.x + c * x - s * y, query.guess.y + s * x + c * y);
            (at.0 - reach.0, at.1 - reach.1)
        };
        let penalty = 0.5 * (off / query.sigma.2).powi(2);
        Turned { points: query.points.iter().map(place).collect(), theta, penalty }
    }
}

struct Search<'a> {
    pyramid: &'a Pyramid,
    query: &'a Query<'a>,
    known: &'a [FoundPose],
    apart: (f64, f64),
    reach: (i32, i32),
    all: Vec<Turned>,
    budget: &'a LookupBudget,
}

impl Search<'_> {
    fn square(&self, level: usize, turn: i32, x: i32, y: i32) -> Square {
        let turned = &self.all[turn as usize];
        let sum = self.sum(level, turned, x, y);
        let side = (1 << level) - 1;
        let off = |low: i32, reach: i32, sigma: f64| {
            let (low, high) = (low - reach, low - reach + side);
            let min = if low > 0 { low } else { (-high).max(0) };
            0.5 * (2.0 * f64::from(min) / sigma).powi(2)
        };
        let prior = turned.penalty
            + off(x, self.reach.0, self.query.sigma.0)
            + off(y, self.reach.1, self.query.sigma.1);
        Square { bound: self.query.gain / 255.0 * f64::from(sum) - prior, turn, x, y }
    }

    fn sum(&self, level: usize, turned: &Turned, x: i32, y: i32) -> u32 {
        let (pyramid, field) = (self.pyramid, &self.pyramid.levels[level]);
        self.budget.take(turned.points.len());
        let mut sum = 0;
        for &(px, py) in &turned.points {
            let (col, row) = ((px + x) as u32 as usize, (py + y) as u32 as usize);
            if col < pyramid.width && row < pyramid.height {
                sum += u32::from(field[row * pyramid.width + col]);
            }
        }
        sum
    }

    fn descend(&self, level: usize, square: Square, best: &mut (f64, Option<FoundPose>)) {
        if square.bound <= best.0 || self.budget.is_spent() {
            return;
        }
        if level == 0 {
            let place = self.place(square);
            if self.known.iter().all(|known| known.is_apart(place.pose, self.apart.0, self.apart.1)) {
                *best = (square.bound, Some(place));
            }
            return;
        }
        let half = 1 << (level - 1);
        let mut parts = [(0, 0), (half, 0), (0, half), (half, half)]
            .map(|(x, y)| self.square(level - 1, square.turn, square.x + x, square.y + y));
        parts.sort_by(|a, b| b.bound.total_cmp(&a.bound));
        for part in parts {
            let inside = part.x <= 2 * self.reach.0 && part.y <= 2 * self.reach.1;
            if inside {
                self.descend(level - 1, part, best);
            }
        }
    }

    fn place(&self, square: Square) -> FoundPose {
        let turned = &self.all[square.turn as usize];
        let shift = |at: i32, reach: i32| 2.0 * f64::from(at - reach);
        let pose = Pose2::new(
            self.query.guess.x + shift(square.x, self.reach.0),
            self.query.guess.y + shift(square.y, self.reach.1),
            turned.theta,
        );
        let sum = self.sum(0, turned, square.x, square.y);
        let fit = f64::from(sum) / 255.0 / self.query.points.len().max(1) as f64;
        FoundPose { pose, score: square.bound, fit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_grid::tiles::{NearestField, NearestObstacle, TileMap};

    #[test]
    fn finds_what_looking_at_every_pose_finds() {
        let model = NearestField::new(6, 2.0);
        let mut map = TileMap::default();
        let at = |i: i32| (i * 37 % 90, i * 53 % 70);
        for i in 0..40 {
            model.insert(&mut map, at(i), NearestObstacle::own(0, 0));
        }
        let truth = Pose2::new(12.0, 20.0, 0.3);
        let points: Vec<_> = (0..25)
            .map(|i| {
                let p = trundle_core::Vector2::new(f64::from(at(i).0) + 0.5, f64::from(at(i).1) + 0.5);
                let q = truth.inverse().transform(p);
                (q.x as f32, q.y as f32)
            })
            .collect();
        let pyramid = Pyramid::new(&map).unwrap();
        let query = Query {
            points: &points,
            guess: Pose2::new(2.0, 40.0, 0.1),
            reach: (40.0, 40.0),
            turn_reach: 0.4,
            turn_step: 0.02,
            sigma: (60.0, 60.0, 1.0),
            gain: 1.0,
        };
        let budget = LookupBudget::unlimited();
        let found = pyramid.search(&query, &[], ((0.0, 0.0), 0.0), &budget).unwrap();
        assert!((found.pose.position() - truth.position()).norm() < 2.5, "{found:?}");
        assert!((found.pose.theta - truth.theta).abs() < 0.03 && found.fit > 0.7, "{found:?}");
        // Every pose of the lattice, one by one.
        let search = Search {
            pyramid: &pyramid,
            query: &query,
            known: &[],
            apart: (0.0, 0.0),
            reach: (20, 20),
            budget: &budget,
            all: (-20..=20).map(|turn| pyramid.turned(&query, turn, (20, 20))).collect(),
        };
        let best = |accept: &dyn Fn(&FoundPose) -> bool| {
            let mut best = f64::NEG_INFINITY;
            for turn in 0..41 {
                for (x, y) in (0..=40).flat_map(|x| (0..=40).map(move |y| (x, y))) {
                    let square = search.square(0, turn, x, y);
                    if square.bound > best && accept(&search.place(square)) {
                        best = square.bound;
                    }
                }
            }
            best
        };
        assert_eq!(found.score, best(&|_| true));
        let second = pyramid.search(&query, &[found], ((10.0, 0.2), 0.0), &budget).unwrap();
        assert_eq!(second.score, best(&|p| found.is_apart(p.pose, 10.0, 0.2)));
        assert!(second.score < found.score);
        let enough = LookupBudget::unlimited();
        pyramid.search(&query, &[], ((0.0, 0.0), 0.0), &enough);
        let few = LookupBudget::new(enough.used() / 4);
        pyramid.search(&query, &[], ((0.0, 0.0), 0.0), &few);
        assert!(few.is_spent() && few.used() == enough.used() / 4);
    }
}
