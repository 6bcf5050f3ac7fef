//! Ranges of lengths and headings of legs between boxes.

use crate::lower_bound::boxes::PositionBox;
use std::f64::consts::{PI, TAU};
use trundle_collision::HeadingArc;
use trundle_core::{Hypotenuse, wrap_angle};

/// Range of the legs between two boxes.
#[derive(Debug, Clone, Copy)]
pub struct LegRange {
    /// Minimum length, m.
    pub min: f64,
    /// Centre of the directions, rad.
    pub direction: f64,
    /// Largest deviation of a direction, rad; pi if unknown.
    pub spread: f64,
}

impl LegRange {
    /// The legs from any position in one box to any position in another.
    pub fn between(from: &PositionBox, to: &PositionBox) -> Self {
        let (d, half) = (to.center - from.center, from.half + to.half);
        let beyond = |x: f64| (x.abs() - half).max(0.0);
        let min = beyond(d.x).hypotenuse(beyond(d.y));
        let direction = d.y.atan2(d.x);
        if min == 0.0 {
            return Self { min, direction, spread: if half == 0.0 && d.norm() > 0.0 { 0.0 } else { PI } };
        }
        // Seen from the origin, a square that does not contain it spans less than half a turn: its corners are the extremes.
        let unit = d.normalize();
        let slope = |x: f64, y: f64| {
            let corner = d + trundle_core::Vector2::new(x, y) * half;
            unit.perp(&corner).abs().atan2(unit.dot(&corner))
        };
        let spread = slope(1.0, 1.0).max(slope(1.0, -1.0)).max(slope(-1.0, 1.0)).max(slope(-1.0, -1.0));
        Self { min, direction, spread }
    }

    /// The headings of the robot on this leg: along it, or against it when driven backward.
    pub fn headings(&self, backward: bool) -> Heading {
        Heading { middle: wrap_angle(self.direction + if backward { PI } else { 0.0 }), spread: self.spread }
    }
}

/// Headings within `spread` of `middle`, rad.
#[derive(Debug, Clone, Copy)]
pub struct Heading {
    pub middle: f64,
    pub spread: f64,
}

impl Heading {
    /// Minimum turn from `heading` into the range, no farther than `left` or `right`; `None` if out of reach.
    pub fn min_turn_from(&self, heading: f64, left: f64, right: f64) -> Option<f64> {
        let to = wrap_angle(self.middle - heading);
        let amounts = [to, to - TAU, to + TAU].into_iter().filter_map(|to| {
            let (low, high) = ((to - self.spread).max(-right), (to + self.spread).min(left));
            (low <= high).then(|| if low > 0.0 { low } else { (-high).max(0.0) })
        });
        amounts.min_by(f64::total_cmp)
    }

    /// Minimum turn from this range into another without contact, with `gaps` the free headings; `None` if no gap contains a
    /// heading of both.
    pub fn min_turn_to(&self, other: &Self, gaps: &[HeadingArc]) -> Option<f64> {
        let direct = (wrap_angle(other.middle - self.middle).abs() - self.spread - other.spread).max(0.0);
        let within = |gap: &HeadingArc| {
            if gap.length >= TAU {
                return Some(direct);
            }
            let (mine, theirs) = (self.within(gap), other.within(gap));
            let apart = |(a, b): (f64, f64), (c, d): (f64, f64)| (c - b).max(a - d).max(0.0);
            let pairs =
                mine.iter().flatten().flat_map(|&m| theirs.iter().flatten().map(move |&t| apart(m, t)));
            pairs.min_by(f64::total_cmp)
        };
        gaps.iter().filter_map(within).min_by(f64::total_cmp)
    }

    /// The parts of the range inside a gap, counted from the gap's start.
    fn within(&self, gap: &HeadingArc) -> [Option<(f64, f64)>; 2] {
        let from = (self.middle - self.spread - gap.start).rem_euclid(TAU);
        let part = |from: f64| {
            let (low, high) = (from.max(0.0), (from + 2.0 * self.spread).min(gap.length));
            (low <= high).then_some((low, high))
        };
        [part(from), part(from - TAU)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    #[test]
    fn turns_stay_inside_the_gaps() {
        let range = |middle, spread| Heading { middle, spread };
        let gap = HeadingArc { start: 0.0, length: 4.0 };
        let turn = range(0.1, 0.1).min_turn_to(&range(wrap_angle(3.8), 0.1), &[gap]).unwrap();
        assert!((turn - 3.5).abs() < 1e-12, "the shorter way round is blocked: {turn}");
        assert!(range(5.0, 0.1).min_turn_to(&range(1.0, 0.1), &[gap]).is_none());
        assert!((range(0.5, 0.1).min_turn_from(0.0, 1.0, 1.0).unwrap() - 0.4).abs() < 1e-12);
        assert!(range(0.5, 0.1).min_turn_from(0.0, 0.3, 1.0).is_none());
    }

    #[test]
    fn legs_between_boxes_are_bounded() {
        let near = PositionBox { center: Vector2::zeros(), half: 0.1 };
        let far = PositionBox { center: Vector2::new(1.0, 0.0), half: 0.1 };
        let leg = LegRange::between(&near, &far);
        assert!((leg.min - 0.8).abs() < 1e-12 && (leg.spread - (0.2_f64 / 0.8).atan()).abs() < 1e-12);
        assert_eq!(LegRange::between(&near, &near).spread, PI);
    }
}
