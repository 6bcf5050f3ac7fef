use super::task::Task;
use crate::space::Space;
use std::f64::consts::PI;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// A heading that a base can turn to where it stands, and how far it can drive along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Rad, map frame.
    pub heading: f64,
    /// Unit vector along the heading.
    pub direction: Vector2,
    /// Free way forward, m.
    pub ahead: f64,
    /// Free way backward, m.
    pub behind: f64,
    /// Time of the turn to it and the pause after, s.
    pub cost: f64,
}

/// Kept from every contact, m and rad: rays are joined from both ends, and what is free from one must be from the other.
const SLACK: f64 = 2e-4;

/// Rays about `pose`: its own heading first, then headings all over the turns that are free: `count` steps over all of
/// them, at least `finest` (rad) each, and both ends.
pub async fn rays(
    task: &Task,
    space: &mut Space<'_>,
    pose: &Pose2,
    count: usize,
    finest: f64,
    found: &mut Vec<Ray>,
) {
    found.clear();
    let free = space.turn(pose);
    let (left, right) = if free.left.is_infinite() { (PI, PI) } else { (free.left, free.right) };
    let step = ((left + right) / count as f64).max(finest);
    let reach = task.longest();
    let mut add = |space: &Space<'_>, turn: f64| {
        let heading = wrap_angle(pose.theta + turn);
        let turned = Pose2 { theta: heading, ..*pose };
        let way = space.drive(&turned, reach);
        let ray = Ray {
            heading,
            direction: turned.direction(),
            ahead: way.ahead - SLACK,
            behind: way.behind - SLACK,
            cost: task.turn_cost(turn),
        };
        found.push(ray);
    };
    add(space, 0.0);
    for (room, sign) in [(left, 1.0), (right, -1.0)] {
        let mut turn = step;
        while turn < room - 5.0 * SLACK {
            add(space, sign * turn);
            turn += step;
            space.rest().await;
        }
        if room > 5.0 * SLACK {
            add(space, sign * (room - SLACK));
        }
    }
}
