//! Legs: straight moves with the turns between them.

use crate::contact_space::ContactSpace;
use crate::legs::query::DockingQuery;
use crate::motion::manoeuvre::Motion;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// A sequence of straight moves: the heading of each (rad, map frame) and its distance (m, backward negative).
///
/// The turns follow from the headings, with one before the first move and one after the last.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Legs(pub Vec<(f64, f64)>);

impl Legs {
    /// Lower bound of the time of these legs, s: every shorter turn counts as free.
    pub fn min_time(&self, query: &DockingQuery) -> f64 {
        let (mut time, mut heading) = (-query.limits.switch_time, query.start.theta);
        for &(next, distance) in &self.0 {
            time += query.turn_cost(wrap_angle(next - heading)) + query.drive_cost(distance);
            heading = next;
        }
        (time + query.turn_cost(wrap_angle(query.goal.theta - heading))).max(0.0)
    }

    /// The motions and their time (s) with pauses, if all motions are free.
    pub fn motions(&self, query: &DockingQuery, space: &mut ContactSpace<'_>) -> Option<(f64, Vec<Motion>)> {
        let (mut motions, mut pose) = (Vec::with_capacity(2 * self.0.len() + 1), query.start);
        let mut time = -query.limits.switch_time;
        for (i, &(heading, distance)) in self.0.iter().enumerate() {
            let turn = free_turn(space, &pose, heading)?;
            pose = Pose2::new(pose.x, pose.y, heading);
            if !space.drive(&pose, distance.abs() + 0.01).allows(distance) {
                return None;
            }
            time += query.turn_cost(turn) + query.drive_cost(distance);
            motions.extend([Motion::Turn(turn), Motion::Drive(distance)]);
            let p = pose.position() + pose.direction() * distance;
            pose = if i + 1 < self.0.len() {
                Pose2 { x: p.x, y: p.y, ..pose }
            } else {
                Pose2 { theta: heading, ..query.goal }
            };
            if !query.in_region(pose.position()) {
                return None;
            }
        }
        let turn = free_turn(space, &pose, query.goal.theta)?;
        time += query.turn_cost(turn);
        motions.push(Motion::Turn(turn));
        Some((time.max(0.0), motions))
    }

    /// Pose of the base after each leg from `start`, with the leg's heading.
    pub fn poses(&self, start: &Pose2) -> impl Iterator<Item = Pose2> + '_ {
        let mut at = start.position();
        self.0.iter().map(move |&(heading, distance)| {
            at += Vector2::new(heading.cos(), heading.sin()) * distance;
            Pose2::new(at.x, at.y, heading)
        })
    }

    /// The ends of the legs from `start`, m.
    pub fn corners(&self, start: &Pose2) -> impl Iterator<Item = Vector2> + '_ {
        self.poses(start).map(|pose| pose.position())
    }

    /// The same headings and first distances, with the last two distances chosen to end at the goal; `None` if the last two headings are
    /// parallel.
    pub fn closed(&self, query: &DockingQuery) -> Option<Self> {
        let n = self.0.len();
        let direction = |(heading, _): (f64, f64)| Vector2::new(heading.cos(), heading.sin());
        let free = self.0[..n - 2].iter().fold(query.start.position(), |p, &leg| p + direction(leg) * leg.1);
        let (u, v) = (direction(self.0[n - 2]), direction(self.0[n - 1]));
        let (rest, cross) = (query.goal.position() - free, u.perp(&v));
        if cross.abs() < 1e-4 {
            return None;
        }
        let mut legs = self.clone();
        legs.0[n - 2].1 = rest.perp(&v) / cross;
        legs.0[n - 1].1 = u.perp(&rest) / cross;
        Some(legs)
    }
}

fn free_turn(space: &mut ContactSpace<'_>, pose: &Pose2, heading: f64) -> Option<f64> {
    let turn = wrap_angle(heading - pose.theta);
    if turn.abs() < 1e-9 { Some(0.0) } else { space.turn(pose).turn_by(turn) }
}
