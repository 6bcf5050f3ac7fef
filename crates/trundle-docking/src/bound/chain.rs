use super::boxes::Place;
use super::ranges::{Heading, LegRange};
use crate::optimal::Task;
use crate::space::{BACK_OFF, FreeTurn};
use std::f64::consts::PI;
use trundle_collision::HeadingArc;

/// Legs of manoeuvres whose turning places are split into boxes, at most.
pub const MOST_LEGS: usize = 4;

/// What is known of both ends.
#[derive(Debug, Clone, Copy)]
pub struct Ends<'t> {
    pub task: &'t Task,
    /// Free turns at the start.
    pub start: &'t FreeTurn,
    /// Free turns at the goal.
    pub goal: &'t FreeTurn,
}

/// Legs from place to place.
#[derive(Debug, Clone, Copy)]
pub struct Chain<'p> {
    /// Start, turning places, goal.
    pub places: &'p [Place],
    pub legs: usize,
    /// Whether each leg may be free, forward and backward.
    pub free: [[bool; 2]; MOST_LEGS],
}

/// A part of a leg's headings, and the least time until the leg is driven.
#[derive(Debug, Clone, Copy)]
struct Sector {
    heading: Heading,
    sum: f64,
}

/// Sectors of a leg at most, forward and backward together.
const MOST_SECTORS: usize = 16;
/// Sectors are about as wide as this, rad, or wider.
const WIDTH: f64 = 0.06;

impl Chain<'_> {
    /// The least time of all manoeuvres through these places, s, where `gaps` are the headings that may be free at each
    /// turning place; `None` when none is possible.
    ///
    /// Each leg's headings are cut into sectors, and the least sum runs over one sector a leg: a leg that could point
    /// anywhere must still point somewhere, so that turns before and after it add up.
    pub fn least_time(&self, ends: &Ends<'_>, gaps: [&[HeadingArc]; MOST_LEGS - 1]) -> Option<f64> {
        let (limits, pause) = (&ends.task.limits, ends.task.limits.switch_time);
        let mut before = Sectors::default();
        for i in 0..self.legs {
            let leg = LegRange::between(&self.places[i], &self.places[i + 1]);
            let mut now = Sectors::of(&leg, self.free[i]);
            let drive = limits.drive_time(leg.least) + pause;
            for sector in now.used_mut() {
                let arrived = if i == 0 {
                    let (left, right) = (ends.start.left + BACK_OFF, ends.start.right + BACK_OFF);
                    let turn = sector.heading.least_turn_from(ends.task.start.theta, left, right);
                    turn.map_or(
                        f64::INFINITY,
                        |turn| if turn > 0.0 { limits.turn_time(turn) + pause } else { 0.0 },
                    )
                } else {
                    let from = |last: &Sector| {
                        let turn = last.heading.least_turn_to(&sector.heading, gaps[i - 1]);
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
            // The turn at the goal runs the other way round, from this heading to the goal's.
            let turn = last.heading.least_turn_from(ends.task.goal.theta, left, right);
            turn.map_or(f64::INFINITY, |turn| {
                last.sum + if turn > 0.0 { limits.turn_time(turn) } else { -pause }
            })
        };
        let least = before.used().iter().map(end).fold(f64::INFINITY, f64::min);
        least.is_finite().then_some(least)
    }
}

#[derive(Debug, Clone, Copy)]
struct Sectors {
    list: [Sector; MOST_SECTORS],
    count: usize,
}

impl Default for Sectors {
    fn default() -> Self {
        let none = Sector { heading: Heading { middle: 0.0, spread: 0.0 }, sum: f64::INFINITY };
        Self { list: [none; MOST_SECTORS], count: 0 }
    }
}

impl Sectors {
    /// The sectors of a leg that may be driven forward or backward.
    fn of(leg: &LegRange, free: [bool; 2]) -> Self {
        let mut sectors = Self::default();
        // Where every direction is open, backward adds none.
        let gears = if leg.spread >= PI { [true, false] } else { free };
        let most = if leg.spread >= PI { MOST_SECTORS } else { MOST_SECTORS / 2 };
        let parts = ((2.0 * leg.spread / WIDTH).ceil() as usize).clamp(1, most);
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
