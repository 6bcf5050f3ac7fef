//! Free turns and straight moves.

use crate::scene::blocker::Blocker;
use std::f64::consts::TAU;
use trundle_collision::{
    HeadingArc, RoundedHull, Segment, StraightContact, blocked_headings, straight_contact,
};
use trundle_core::{Pose2, Vector2};

/// Distance from a contact at which motions stop, m or rad: the next motion then begins without contact. Source: ours.
pub const BACK_OFF: f64 = 1e-5;
/// Rounding of sums of headings and distances, m or rad; far less than [`BACK_OFF`]. Source: ours.
const ROUNDING_SLACK: f64 = 1e-9;

/// Free turn in place of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeTurn {
    /// Counter-clockwise until the first contact, rad; infinite without any contact.
    pub left: f64,
    /// Clockwise until the first contact, rad.
    pub right: f64,
    /// The obstacle counter-clockwise.
    pub left_by: Option<Blocker>,
    /// The obstacle clockwise.
    pub right_by: Option<Blocker>,
}

impl FreeTurn {
    pub(crate) const ALL_ROUND: Self =
        Self { left: f64::INFINITY, right: f64::INFINITY, left_by: None, right_by: None };

    /// Reduces the free turn by a segment, for a hull at a pose. The last two arguments are buffers.
    pub(crate) fn limit_by(
        &mut self,
        hull: &RoundedHull,
        segment: &Segment,
        number: u32,
        pose: &Pose2,
        angles: &mut Vec<f64>,
        arcs: &mut Vec<HeadingArc>,
    ) {
        arcs.clear();
        let center = pose.position();
        blocked_headings(hull, &segment.in_frame(center, 1.0, 0.0), angles, arcs);
        for arc in arcs.iter() {
            let (left, right) = arc.free_turn_from(pose.theta);
            let blocker = || Some(Blocker::listed(number, segment.nearest(center)));
            if left < self.left {
                (self.left, self.left_by) = (left, blocker());
            }
            if right < self.right {
                (self.right, self.right_by) = (right, blocker());
            }
        }
    }

    /// Whether a turn by `angle` (rad, counter-clockwise positive) is free.
    pub fn allows(&self, angle: f64) -> bool {
        angle <= self.left + ROUNDING_SLACK && -angle <= self.right + ROUNDING_SLACK
    }

    /// The turn that changes the heading by `angle` (in (-pi, pi], rad): the shorter turn if it is free, else the longer.
    pub fn turn_by(&self, angle: f64) -> Option<f64> {
        let longer = -(TAU - angle.abs()).copysign(angle);
        [angle, longer].into_iter().find(|&turn| self.allows(turn))
    }
}

/// Free straight moves of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeDrive {
    /// Forward until the first contact, m, at most the requested distance.
    pub ahead: f64,
    /// Backward until the first contact, m.
    pub behind: f64,
    /// The obstacle ahead.
    pub ahead_by: Option<Blocker>,
    /// The obstacle behind.
    pub behind_by: Option<Blocker>,
}

impl FreeDrive {
    /// Reduces the free distances by a segment in the hull's frame; `blocker` yields its number and position.
    pub(crate) fn limit_by(
        &mut self,
        hull: &RoundedHull,
        seen: &Segment,
        blocker: impl Fn() -> (u32, Vector2),
    ) {
        let by = || {
            let (number, at) = blocker();
            Some(Blocker::listed(number, at))
        };
        match straight_contact(hull, seen) {
            Some(StraightContact::Ahead(distance)) if distance < self.ahead => {
                (self.ahead, self.ahead_by) = (distance, by())
            }
            Some(StraightContact::Behind(distance)) if distance < self.behind => {
                (self.behind, self.behind_by) = (distance, by())
            }
            _ => {}
        }
    }

    /// Whether a straight move over the distance `distance` (m, backward negative) is free.
    pub fn allows(&self, distance: f64) -> bool {
        distance <= self.ahead + ROUNDING_SLACK && -distance <= self.behind + ROUNDING_SLACK
    }
}
