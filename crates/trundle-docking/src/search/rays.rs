//! Rays: headings that the base can turn to, with the free distances along them.

use crate::contact_space::ContactSpace;
use crate::legs::query::DockingQuery;
use std::f64::consts::PI;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// A heading that a base can turn to in place, and the free distances along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Rad, map frame.
    pub heading: f64,
    /// Unit vector along the heading.
    pub direction: Vector2,
    /// Free distance forward, m.
    pub ahead: f64,
    /// Free distance backward, m.
    pub behind: f64,
    /// Time of the turn to the heading and the following pause, s.
    pub cost: f64,
}

/// Distance from every contact, m and rad: rays are joined from both ends, and must be free from either end. Source: ours.
const CONTACT_SLACK: f64 = 2e-4;

/// Rays around `pose`: first its own heading, then `count` headings over all free turns, at least `finest` (rad) apart, and both ends.
pub async fn rays(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    pose: &Pose2,
    count: usize,
    finest: f64,
    found: &mut Vec<Ray>,
) {
    found.clear();
    let free = space.turn(pose);
    let (left, right) = if free.left.is_infinite() { (PI, PI) } else { (free.left, free.right) };
    let step = ((left + right) / count as f64).max(finest);
    let reach = query.longest();
    let mut add = |space: &ContactSpace<'_>, turn: f64| {
        let heading = wrap_angle(pose.theta + turn);
        let turned = Pose2 { theta: heading, ..*pose };
        let distance = space.drive(&turned, reach);
        let ray = Ray {
            heading,
            direction: turned.direction(),
            ahead: distance.ahead - CONTACT_SLACK,
            behind: distance.behind - CONTACT_SLACK,
            cost: query.turn_cost(turn),
        };
        found.push(ray);
    };
    add(space, 0.0);
    for (room, sign) in [(left, 1.0), (right, -1.0)] {
        let mut turn = step;
        while turn < room - 5.0 * CONTACT_SLACK {
            add(space, sign * turn);
            turn += step;
            space.yield_point().await;
        }
        if room > 5.0 * CONTACT_SLACK {
            add(space, sign * (room - CONTACT_SLACK));
        }
    }
}
