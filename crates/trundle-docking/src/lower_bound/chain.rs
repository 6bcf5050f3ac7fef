//! Lower bound of the time of a chain of legs through boxes of turning positions.

use crate::free_motion::{BACK_OFF, FreeTurn};
use crate::legs::query::DockingQuery;
use crate::lower_bound::boxes::PositionBox;
use crate::lower_bound::ranges::{Heading, LegRange};
use std::f64::consts::PI;
use trundle_collision::HeadingArc;

/// Largest number of legs whose turning positions are split into boxes. Longer chains have a coarser bound. Source: ours.
pub const MAX_SPLIT_LEGS: usize = 4;

/// Both ends of a chain, with their free turns.
#[derive(Debug, Clone, Copy)]
pub struct Ends<'t> {
    pub query: &'t DockingQuery,
    /// Free turns at the start.
    pub start: &'t FreeTurn,
    /// Free turns at the goal.
    pub goal: &'t FreeTurn,
}

/// A chain of legs between boxes of positions.
#[derive(Debug, Clone, Copy)]
pub struct Chain<'p> {
    /// Start, turning positions, goal.
    pub places: &'p [PositionBox],
    pub legs: usize,
    /// Whether each leg may be free, forward and backward.
    pub free: [[bool; 2]; MAX_SPLIT_LEGS],
}

/// A part of a leg's headings, and the lower bound of the time until the leg is driven.
#[derive(Debug, Clone, Copy)]
struct Sector {
    heading: Heading,
    sum: f64,
}

/// Largest number of sectors of a leg, forward and backward together. Source: ours.
const MAX_SECTORS: usize = 16;
/// Width of a sector, rad; wider if a leg has more headings than sectors. Source: ours.
const SECTOR_WIDTH_RAD: f64 = 0.06;

impl Chain<'_> {
    /// Lower bound of the time of all manoeuvres through these boxes, s; `None` if none is possible. `gaps` are the headings that may be
    /// free at each turning position.
    ///
    /// Each leg's headings are cut into sectors, and the minimum runs over one sector per leg. A leg that could point anywhere still has
    /// one direction, so the turns before and after it add up.
    pub fn min_time(&self, ends: &Ends<'_>, gaps: [&[HeadingArc]; MAX_SPLIT_LEGS - 1]) -> Option<f64> {
        let (limits, pause) = (&ends.query.limits, ends.query.limits.switch_time);
        let mut before = Sectors::default();
        for i in 0..self.legs {
            let leg = LegRange::between(&self.places[i], &self.places[i + 1]);
            let mut now = Sectors::of(&leg, self.free[i]);
            let drive = limits.drive_time(leg.min) + pause;
            for sector in now.used_mut() {
                let arrived = if i == 0 {
                    let (left, right) = (ends.start.left + BACK_OFF, ends.start.right + BACK_OFF);
                    let turn = sector.heading.min_turn_from(ends.query.start.theta, left, right);
                    turn.map_or(
                        f64::INFINITY,
                        |turn| if turn > 0.0 { limits.turn_time(turn) + pause } else { 0.0 },
                    )
                } else {
                    let from = |last: &Sector| {
                        let turn = last.heading.min_turn_to(&sector.heading, gaps[i - 1]);
                        turn.map_or(f64::INFINITY, |turn| last.sum + limits.turn_time(turn) + pause)
                    };
                    before
                        .used()
                        .iter()
                        .filter(|last| last.sum.is_finite())
                        .map(from)
                        .fold(f64::INFINITY, f64::min)
                };
                sector.sum = arrived + drive;
            }
            before = now;
        }
        let (left, right) = (ends.goal.left + BACK_OFF, ends.goal.right + BACK_OFF);
        let end = |last: &Sector| {
            // The turn at the goal is counted in reverse, from this heading to the goal's.
            let turn = last.heading.min_turn_from(ends.query.goal.theta, left, right);
            turn.map_or(f64::INFINITY, |turn| {
                last.sum + if turn > 0.0 { limits.turn_time(turn) } else { -pause }
            })
        };
        let min = before.used().iter().map(end).fold(f64::INFINITY, f64::min);
        min.is_finite().then_some(min)
    }
}

#[derive(Debug, Clone, Copy)]
struct Sectors {
    list: [Sector; MAX_SECTORS],
    count: usize,
}

impl Default for Sectors {
    fn default() -> Self {
        let none = Sector { heading: Heading { middle: 0.0, spread: 0.0 }, sum: f64::INFINITY };
        Self { list: [none; MAX_SECTORS], count: 0 }
    }
}

impl Sectors {
    /// The sectors of a leg that may be driven forward or backward.
    fn of(leg: &LegRange, free: [bool; 2]) -> Self {
        let mut sectors = Self::default();
        // If every direction is open, the backward direction adds none.
        let gears = if leg.spread >= PI { [true, false] } else { free };
        let max = if leg.spread >= PI { MAX_SECTORS } else { MAX_SECTORS / 2 };
        let parts = ((2.0 * leg.spread / SECTOR_WIDTH_RAD).ceil() as usize).clamp(1, max);
        for backward in [false, true].into_iter().filter(|&backward| gears[usize::from(backward)]) {
            let all = leg.headings(backward);
            let spread = all.spread / parts as f64;
            for k in 0..parts {
                let middle = all.middle - all.spread + spread * (2 * k + 1) as f64;
                let heading = Heading { middle: trundle_core::wrap_angle(middle), spread };
                sectors.list[sectors.count] = Sector { heading, sum: f64::INFINITY };
                sectors.count += 1;
            }
        }
        sectors
    }

    fn used(&self) -> &[Sector] {
        &self.list[..self.count]
    }

    fn used_mut(&mut self) -> &mut [Sector] {
        &mut self.list[..self.count]
    }
}
