//! Branch and bound over boxes of turning positions.

use crate::contact_space::ContactSpace;
use crate::free_motion::FreeTurn;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::lower_bound::boxes::{PositionBox, Region, Square};
use crate::lower_bound::chain::{Chain, Ends, MAX_SPLIT_LEGS};
use crate::lower_bound::leg_feasibility::ShrunkHulls;
use crate::lower_bound::ranges::LegRange;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use trundle_collision::HeadingArc;
use trundle_core::wrap_angle;

/// Finest level of the squares: 2 mm in a region of 4 m. Source: ours.
const FINEST_LEVEL: u8 = 11;
/// Counted cost of a box without its contact queries, in units of [`ContactSpace::work`]. Source: ours.
const BOX_COST: u64 = 100;
/// Smallest level at which the centres of the squares are tried as a manoeuvre. Source: ours.
const FIRST_TRIED_LEVEL: u8 = 6;

/// Result of branch and bound.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounded {
    /// Lower bound of the time of any manoeuvre, s.
    pub bound: f64,
    /// The best known legs, and their time, s.
    pub best: Option<(f64, Legs)>,
    /// Number of boxes expanded.
    pub boxes: usize,
}

/// A family of manoeuvres: those with turns in given squares.
#[derive(Debug, Clone, Copy)]
struct Family {
    bound: f64,
    /// Number of turning positions in use.
    turns: usize,
    squares: [Square; MAX_SPLIT_LEGS - 1],
    /// Whether the contacts of the family have been tested.
    tested: bool,
}

impl PartialEq for Family {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Family {}
impl PartialOrd for Family {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Family {
    /// The heap returns the smallest bound first; ties are broken by squares, for a unique order.
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |f: &Self| (f.turns, f.squares);
        other.bound.total_cmp(&self.bound).then_with(|| key(other).cmp(&key(self)))
    }
}

/// Raises the bound, and improves the legs if a box contains better ones. Ends when both differ by at most `gap` (a part), when `max`
/// boxes have been expanded, or when [`ContactSpace::work`] reaches `limit`.
pub async fn improve(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    best: Option<(f64, Legs)>,
    gap: f64,
    (max, limit): (usize, u64),
) -> Bounded {
    let free = Bounding { query, region: region(query), start: FULL_TURN, goal: FULL_TURN, shrunk: None };
    let (spare, used) = free.min_free_time(max / 4);
    let shrunk = ShrunkHulls::new(space);
    let (start, goal) = (space.turn(&query.start), space.turn(&query.goal));
    let mut bounding = Bounding { query, region: region(query), start, goal, shrunk: Some(shrunk) };
    let pauses = |legs: usize| (2 * legs - 2) as f64 * query.limits.switch_time;
    let mut queue = BinaryHeap::new();
    for turns in 1..MAX_SPLIT_LEGS {
        let bound = spare + pauses(turns + 1);
        queue.push(Family { bound, turns, squares: [Square::ALL; MAX_SPLIT_LEGS - 1], tested: false });
    }
    let straight = bounding.straight(space);
    let more = spare + pauses(MAX_SPLIT_LEGS + 1);
    let mut known = Bounded { bound: 0.0, best, boxes: used };
    loop {
        let time = known.best.as_ref().map_or(f64::INFINITY, |(time, _)| *time);
        let open = queue.peek().map_or(f64::INFINITY, |family: &Family| family.bound);
        known.bound = open.min(more).min(straight).min(time);
        let done = known.bound >= time * (1.0 - gap) || known.bound < open;
        if done || known.boxes >= max || space.work() >= limit {
            return known;
        }
        let Some(family) = queue.pop() else { return known };
        known.boxes += 1;
        space.spend(BOX_COST);
        space.yield_point().await;
        if !family.tested {
            if let Some(bound) = bounding.tested_bound(&family)
                && bound < time
            {
                queue.push(Family { bound: bound.max(family.bound), tested: true, ..family });
            }
            continue;
        }
        bounding.try_middles(&family, space, &mut known);
        let widest =
            (0..family.turns).min_by_key(|&i| family.squares[i].level).expect("invariant: a family turns");
        if family.squares[widest].level >= FINEST_LEVEL {
            // The finest squares are not split: their bound is final.
            known.bound = family.bound;
            return known;
        }
        for quarter in family.squares[widest].quarters() {
            let mut squares = family.squares;
            squares[widest] = quarter;
            let child = Family { squares, tested: false, ..family };
            let bound = bounding.bound(&child).max(family.bound);
            if bound < time {
                queue.push(Family { bound, ..child });
            }
        }
    }
}

const FULL_TURN: FreeTurn =
    FreeTurn { left: f64::INFINITY, right: f64::INFINITY, left_by: None, right_by: None };

fn region(query: &DockingQuery) -> Region {
    Region { center: query.center(), half: query.half() }
}

struct Bounding<'t, 'a> {
    query: &'t DockingQuery,
    region: Region,
    start: FreeTurn,
    goal: FreeTurn,
    shrunk: Option<ShrunkHulls<'a>>,
}

impl Bounding<'_, '_> {
    /// Time of a straight drive to the goal, s; infinite if the drive is not free. It covers manoeuvres of one leg or none.
    fn straight(&self, space: &mut ContactSpace<'_>) -> f64 {
        let rest = self.query.goal.position() - self.query.start.position();
        let toward = if rest.norm() > 1e-9 { rest.y.atan2(rest.x) } else { self.query.start.theta };
        let back = wrap_angle(toward + std::f64::consts::PI);
        let time = |leg| Legs(vec![leg]).motions(self.query, space).map_or(f64::INFINITY, |(time, _)| time);
        [(toward, rest.norm()), (back, -rest.norm())].map(time).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Lower bound of the motions' time alone (no pauses) over all manoeuvres of up to two legs without obstacles, and the number
    /// of boxes expanded.
    fn min_free_time(&self, max: usize) -> (f64, usize) {
        let calm = DockingQuery {
            limits: crate::motion::limits::MotionLimits { switch_time: 0.0, ..self.query.limits },
            ..*self.query
        };
        let calm =
            Bounding { query: &calm, region: self.region, start: self.start, goal: self.goal, shrunk: None };
        let rest = calm.query.goal.position() - calm.query.start.position();
        let toward = if rest.norm() > 1e-9 { rest.y.atan2(rest.x) } else { calm.query.start.theta };
        let legs = |heading, distance| Legs(vec![(heading, distance)]).min_time(calm.query);
        let mut time =
            legs(toward, rest.norm()).min(legs(wrap_angle(toward + std::f64::consts::PI), -rest.norm()));
        let mut queue = BinaryHeap::new();
        queue.push(Family {
            bound: 0.0,
            turns: 1,
            squares: [Square::ALL; MAX_SPLIT_LEGS - 1],
            tested: false,
        });
        let mut boxes = 0;
        while let Some(family) = queue.pop() {
            boxes += 1;
            if family.bound >= 0.98 * time || boxes >= max.max(50) || family.squares[0].level >= FINEST_LEVEL
            {
                return (family.bound.min(time), boxes);
            }
            time = time.min(calm.free_time_of_middle(&family));
            for quarter in family.squares[0].quarters() {
                let child = Family { squares: [quarter; MAX_SPLIT_LEGS - 1], ..family };
                let bound = calm.bound(&child).max(family.bound);
                if bound < time {
                    queue.push(Family { bound, ..child });
                }
            }
        }
        (time, boxes)
    }

    fn free_time_of_middle(&self, family: &Family) -> f64 {
        self.legs_of_middles(family, 0b00)
            .into_iter()
            .chain([0b01, 0b10, 0b11].into_iter().flat_map(|gears| self.legs_of_middles(family, gears)))
            .map(|legs| legs.min_time(self.query))
            .fold(f64::INFINITY, f64::min)
    }

    /// Start, turning positions, goal.
    fn places(&self, family: &Family) -> [PositionBox; MAX_SPLIT_LEGS + 1] {
        let mut places = [PositionBox::exactly(self.query.goal.position()); MAX_SPLIT_LEGS + 1];
        places[0] = PositionBox::exactly(self.query.start.position());
        for i in 0..family.turns {
            places[i + 1] = self.region.place(family.squares[i]);
        }
        places
    }

    /// Lower bound of the time of every manoeuvre of a family, s; contacts only of the first and the last turn.
    fn bound(&self, family: &Family) -> f64 {
        let open: &[HeadingArc] = &[HeadingArc::FULL];
        let ends = Ends { query: self.query, start: &self.start, goal: &self.goal };
        let chain = Chain {
            places: &self.places(family)[..],
            legs: family.turns + 1,
            free: [[true; 2]; MAX_SPLIT_LEGS],
        };
        chain.min_time(&ends, [open; MAX_SPLIT_LEGS - 1]).unwrap_or(f64::INFINITY)
    }

    /// The same bound with contacts; `None` if every manoeuvre of the family has a contact.
    fn tested_bound(&mut self, family: &Family) -> Option<f64> {
        let places = self.places(family);
        let shrunk = self.shrunk.as_mut().expect("invariant: contacts are asked for among obstacles");
        let mut free = [[true; 2]; MAX_SPLIT_LEGS];
        for i in 0..=family.turns {
            let leg = LegRange::between(&places[i], &places[i + 1]);
            free[i] =
                [false, true].map(|backward| shrunk.may_drive(&places[i], &places[i + 1], &leg, backward));
        }
        for square in &family.squares[..family.turns] {
            shrunk.find_gaps(&self.region, *square);
        }
        let mut gaps: [&[HeadingArc]; MAX_SPLIT_LEGS - 1] = [&[]; MAX_SPLIT_LEGS - 1];
        for (gaps, square) in gaps.iter_mut().zip(&family.squares[..family.turns]) {
            *gaps = shrunk.gaps(*square);
        }
        let ends = Ends { query: self.query, start: &self.start, goal: &self.goal };
        Chain { places: &places[..], legs: family.turns + 1, free }.min_time(&ends, gaps)
    }

    /// Tries the centres of small squares as a manoeuvre.
    fn try_middles(&self, family: &Family, space: &mut ContactSpace<'_>, known: &mut Bounded) {
        if family.squares[..family.turns].iter().any(|square| square.level < FIRST_TRIED_LEVEL) {
            return;
        }
        for gears in 0..1_u32 << (family.turns + 1) {
            let Some(legs) = self.legs_of_middles(family, gears) else { continue };
            let time = known.best.as_ref().map_or(f64::INFINITY, |(time, _)| *time);
            if legs.min_time(self.query) >= time {
                continue;
            }
            if let Some((found, _)) = legs.motions(self.query, space)
                && found < time
            {
                known.best = Some((found, legs));
            }
        }
    }

    /// The legs through the centres; bit i of `gears` means that leg i is driven backward.
    fn legs_of_middles(&self, family: &Family, gears: u32) -> Option<Legs> {
        let places = self.places(family);
        let leg = |i: usize| {
            let d = places[i + 1].center - places[i].center;
            let back = gears >> i & 1 == 1;
            let turn = if back { std::f64::consts::PI } else { 0.0 };
            let distance = if back { -d.norm() } else { d.norm() };
            (distance != 0.0).then(|| (wrap_angle(d.y.atan2(d.x) + turn), distance))
        };
        (0..=family.turns).map(leg).collect::<Option<Vec<_>>>().map(Legs)
    }
}
