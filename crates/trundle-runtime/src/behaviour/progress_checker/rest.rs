//! What is left to drive and to turn to a goal, as a length.

use crate::behaviour::state::State;
use crate::behaviour::station_drive::StationGoal;
use crate::behaviour::tools::Tools;
use crate::world_state::WorldState;
use trundle_core::{Pose2, Trajectory, difference_of_angles};

/// What is left in a state \[m\]. Infinite: no path is known. `None`: the state has a limit of its own, and the guard pauses.
pub(crate) fn rest(state: &State, tools: &Tools, s: &WorldState<'_>) -> Option<f64> {
    let (pose, radius) = (s.estimate.pose, tools.body.radius);
    let to_goal = || tools.goal.pose().map_or(f64::INFINITY, |goal| motion_between(&pose, &goal, radius));
    Some(match state {
        // Neither a turn at a charging station nor a wait for the view has a limit of its own.
        State::Station(station) if matches!(station.goal, StationGoal::Sweep(_)) => f64::INFINITY,
        State::Maneuver if tools.view_monitor.is_blind(s) => f64::INFINITY,
        State::Station(_) | State::Maneuver | State::Confirm(_) => return None,
        State::Relative(relative) => relative.drive.rest(relative.motion, pose, radius),
        State::Spin(spin) => radius * spin.rest(),
        State::Approach => to_goal(),
        State::Face(heading) => radius * difference_of_angles(pose.theta, *heading).abs(),
        State::Drive(_) => path_rest(tools).unwrap_or(f64::INFINITY),
        State::Wait(wait) => path_rest(tools).or(wait.search.rest_over_unseen_floor).unwrap_or(f64::INFINITY),
        State::Plan(search) => search.rest_over_unseen_floor.unwrap_or(f64::INFINITY),
        State::Recover(recover) => recover.search.rest_over_unseen_floor.unwrap_or(f64::INFINITY),
        State::Idle | State::Initialize | State::Relocalize { .. } => f64::INFINITY,
        State::Arrived | State::Stopped { .. } => return None,
    })
}

/// The rest of the path that the robot follows; `None` if it follows none.
fn path_rest(tools: &Tools) -> Option<f64> {
    let plan = tools.plan.as_ref()?;
    let time = tools.follower.reference().map_or(plan.result.trajectory.duration(), |point| point.time);
    Some(length(&plan.result.trajectory, time, tools.body.radius))
}

/// Length of a trajectory from `time` \[s\] on, with its turns as the way of a point at `radius` \[m\].
pub(crate) fn length(path: &Trajectory, time: f64, radius: f64) -> f64 {
    let points = path.points();
    let rest = &points[points.partition_point(|point| point.time <= time)..];
    let mut last = path.at(time).pose;
    rest.iter()
        .map(|point| motion_between(&std::mem::replace(&mut last, point.pose), &point.pose, radius))
        .sum()
}

/// Distance between two poses, and their turn as the way of a point at `radius` \[m\].
pub(crate) fn motion_between(from: &Pose2, to: &Pose2, radius: f64) -> f64 {
    from.distance(to) + radius * difference_of_angles(from.theta, to.theta).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{TrajectoryPoint, Twist2};

    #[test]
    fn the_rest_of_a_path_falls_by_what_is_driven_and_turned() {
        // A turn of 1 rad in 2 s, then 3 m in 6 s.
        let pose = |time: f64| Pose2::new(0.5 * (time - 2.0).max(0.0), 0.0, (0.5 * time).min(1.0) - 1.0);
        let points = (0..=80).map(|i| 0.1 * f64::from(i));
        let point = |time| TrajectoryPoint { time, pose: pose(time), twist: Twist2::ZERO };
        let path = Trajectory::new(points.map(point).collect()).unwrap();
        for (time, rest) in
            [(-1.0, 3.2), (0.0, 3.2), (1.03, 3.097), (2.0, 3.0), (5.04, 1.48), (8.0, 0.0), (9.0, 0.0)]
        {
            assert!((length(&path, time, 0.2) - rest).abs() < 1e-9, "{time} s: {}", length(&path, time, 0.2));
        }
    }
}
