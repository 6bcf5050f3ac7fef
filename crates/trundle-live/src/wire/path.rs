//! Paths as bytes, in the map frame: kind, a byte of 0, the number of way-points in 2 bytes, then each point in numbers of 4 bytes. The
//! planned path: x, y \[m\], first of the way-points, then of the curve. The driven path has no way-points: x, y \[m\], heading \[rad\],
//! time of the robot \[s\].

use super::Kind;
use trundle_app::operator::PlanView;
use trundle_core::{Pose2, TrajectoryPoint, Vector2};

/// Maximum number of points of a curve, and of way-points; longer ones are thinned. Source: ours.
const MAX_PLAN_POINTS: usize = 400;

/// The message of a planned path; without points for `None`.
pub fn path_message(plan: Option<&PlanView>) -> Vec<u8> {
    let Some(plan) = plan else { return message(Kind::Plan, 0, [].into_iter()) };
    let waypoints: Vec<&Vector2> = thinned(&plan.waypoints).collect();
    let curve = thinned(plan.trajectory.points());
    let flat = waypoints.iter().flat_map(|point| [point.x, point.y]);
    let count = waypoints.len() as u16;
    message(Kind::Plan, count, flat.chain(curve.flat_map(|TrajectoryPoint { pose, .. }| [pose.x, pose.y])))
}

/// At most about [`MAX_PLAN_POINTS`] of the points, the last one included.
fn thinned<T>(points: &[T]) -> impl Iterator<Item = &T> {
    let stride = points.len().div_ceil(MAX_PLAN_POINTS).max(1);
    let last = points.last().filter(|_| points.len() % stride != 1);
    points.iter().step_by(stride).chain(last.filter(|_| stride > 1))
}

/// The message of the driven path: poses and their times \[s\].
pub fn trail_message(points: impl Iterator<Item = (f64, Pose2)>) -> Vec<u8> {
    message(Kind::Trail, 0, points.flat_map(|(time, pose)| [pose.x, pose.y, pose.theta, time]))
}

fn message(kind: Kind, waypoints: u16, numbers: impl Iterator<Item = f64>) -> Vec<u8> {
    let mut bytes = vec![kind as u8, 0];
    bytes.extend(waypoints.to_le_bytes());
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

    #[test]
    fn way_points_stand_before_the_curve() {
        use trundle_core::{Trajectory, Twist2};
        let at = |x: f64| TrajectoryPoint { time: 0.0, pose: Pose2::new(x, 0.0, 0.0), twist: Twist2::ZERO };
        let trajectory = Trajectory::new(vec![at(3.0)]).unwrap();
        let plan = PlanView { waypoints: vec![Vector2::new(1.0, 2.0)], trajectory };
        let bytes = path_message(Some(&plan));
        let numbers: Vec<f32> =
            bytes[4..].chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
        assert_eq!((&bytes[..4], &numbers[..]), (&[3, 0, 1, 0][..], &[1.0, 2.0, 3.0, 0.0][..]));
        let long: Vec<usize> = (0..1000).collect();
        let few: Vec<_> = thinned(&long).collect();
        assert!(few.len() <= MAX_PLAN_POINTS && few.last() == Some(&&999), "{}", few.len());
    }
}
