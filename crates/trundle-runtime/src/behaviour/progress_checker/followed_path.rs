//! The last path to the goal, kept after an obstacle has blocked it.

use trundle_core::{Cell, OccupancyGrid, Pose2, Trajectory};

/// The last path to the goal.
#[derive(Debug, Clone)]
pub(crate) struct FollowedPath {
    pub(crate) trajectory: Trajectory,
    /// The robot's time on the path, s.
    pub(crate) time: f64,
    /// Time on the path until which the floor under it was seen free, s.
    seen_until: f64,
}

/// Distance of seen free floor behind a contact, in addition to the robot's radius, that makes the obstacle a new one \[m\]. Source: ours, three
/// cells.
const MIN_SEEN_BEHIND_M: f64 = 0.15;

impl FollowedPath {
    /// A path that begins now.
    pub(crate) fn new(trajectory: Trajectory) -> Self {
        Self { trajectory, time: 0.0, seen_until: 0.0 }
    }

    /// Records the robot's time on the path, s, and the floor that is seen free.
    pub(crate) fn note(&mut self, time: f64, floor: &OccupancyGrid) {
        self.time = time;
        let points = self.trajectory.points();
        let next = points.partition_point(|point| point.time <= self.seen_until.max(time));
        let free = points[next..].iter().take_while(|point| floor.at(point.pose.position()) == Cell::Free);
        self.seen_until = free.last().map_or(self.seen_until, |point| point.time);
    }

    /// Whether the floor behind a contact at `time` \[s\] and `pose` was seen free before: the obstacle has come there since. `radius`: of the
    /// robot, m.
    pub(crate) fn was_free(&self, time: f64, pose: &Pose2, radius: f64) -> bool {
        let last = self.trajectory.at(self.seen_until).pose;
        let is_behind = last.distance(pose) > radius + MIN_SEEN_BEHIND_M;
        self.seen_until > time && (is_behind || self.seen_until >= self.trajectory.duration())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::behaviour::navigator::testing::floor;
    use trundle_core::{TrajectoryPoint, Twist2};

    /// A path along x from 1 to 5 m in 8 s.
    fn path() -> FollowedPath {
        let pose = |time: f64| Pose2::new(1.0 + 0.5 * time, 2.0, 0.0);
        let point = |i| TrajectoryPoint {
            time: 0.1 * f64::from(i),
            pose: pose(0.1 * f64::from(i)),
            twist: Twist2::ZERO,
        };
        FollowedPath::new(Trajectory::new((0..=80).map(point).collect()).unwrap())
    }

    #[test]
    fn an_obstacle_on_floor_that_was_seen_free_is_new_and_a_wall_in_the_unknown_is_not() {
        let contact =
            |path: &FollowedPath, time: f64| path.was_free(time, &path.trajectory.at(time).pose, 0.2);
        let mut path = path();
        path.note(0.0, &floor(|at| at.x > 3.0));
        assert!(contact(&path, 3.0), "2.5 m, and the floor up to 3 m was seen");
        assert!(!contact(&path, 3.6), "2.8 m: the wall may be at 3 m");
        assert!(!contact(&path, 6.0));
        // An obstacle hides the floor behind it, and takes nothing back.
        path.note(1.0, &floor(|at| at.x > 2.0));
        assert!(contact(&path, 3.0));
        path.note(2.0, &floor(|_| false));
        assert!(contact(&path, 6.0) && contact(&path, 7.9), "up to the goal");
    }
}
