//! Paths as bytes, in the map frame: kind, 3 bytes of 0, then each point in numbers of 4 bytes. The planned path: x, y \[m\]. The driven path:
//! x, y \[m\], heading \[rad\], time of the robot \[s\].

use super::Kind;
use trundle_core::{Pose2, Trajectory};

/// Maximum number of points of a planned path; a longer one is thinned. Source: ours.
const MAX_PLAN_POINTS: usize = 400;

/// The message of a planned path; without points for `None`.
pub fn path_message(plan: Option<&Trajectory>) -> Vec<u8> {
    let points = plan.map_or(&[][..], Trajectory::points);
    let stride = points.len().div_ceil(MAX_PLAN_POINTS).max(1);
    let last = points.last().filter(|_| points.len() % stride != 1);
    let thinned = points.iter().step_by(stride).chain(last.filter(|_| stride > 1));
    message(Kind::Plan, thinned.flat_map(|point| [point.pose.x, point.pose.y]))
}

/// The message of the driven path: poses and their times \[s\].
pub fn trail_message(points: impl Iterator<Item = (f64, Pose2)>) -> Vec<u8> {
    message(Kind::Trail, points.flat_map(|(time, pose)| [pose.x, pose.y, pose.theta, time]))
}

fn message(kind: Kind, numbers: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut bytes = vec![kind as u8, 0, 0, 0];
    numbers.for_each(|number| bytes.extend((number as f32).to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_plan_is_an_empty_path() {
        assert_eq!(path_message(None), [3, 0, 0, 0]);
        let trail = trail_message([(0.5, Pose2::new(1.0, 2.0, 3.0))].into_iter());
        assert_eq!((trail[0], &trail[16..]), (5, &0.5_f32.to_le_bytes()[..]));
    }
}
