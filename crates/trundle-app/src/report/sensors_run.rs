//! The outcome of a run on the sensors of a robot that something else drove: it located itself, or not.

use crate::FinishedRun;
use serde::{Deserialize, Serialize};
use trundle_core::Cell;

/// Share of a run's time at an unknown pose \[1\]. Above it the run failed. Source: ours, as for frames without a pose in `trundle slam`.
const MAX_SHARE_LOST: f64 = 0.1;

/// What the sensors of a robot that something else drove gave.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SensorsRun {
    /// Images with a pose by their features.
    pub images_tracked: usize,
    /// Scans, of a laser or of depth images, that were matched to the map.
    pub scans_matched: usize,
    /// Whether the map has an obstacle.
    pub has_obstacles: bool,
    /// Time during which the pose was unknown, or too uncertain to drive \[s\].
    pub pose_lost_s: f64,
}

impl SensorsRun {
    /// The counts of a run that has ended.
    pub fn of(run: &FinishedRun) -> Self {
        let log = &run.log;
        Self {
            images_tracked: log.tracked.ok + log.tracked.weak,
            scans_matched: log.scans_matched,
            has_obstacles: run.robot.grid().cells().contains(&Cell::Occupied),
            pose_lost_s: log.pose_lost_s,
        }
    }

    /// The reason why the robot did not locate itself in a run of `duration` seconds; `None` if it did.
    #[must_use]
    pub fn failure(&self, duration: f64) -> Option<String> {
        if self.images_tracked == 0 && self.scans_matched == 0 {
            return Some("the robot tracked no image and matched no scan to its map".to_owned());
        }
        if self.images_tracked == 0 && !self.has_obstacles {
            return Some("no scan showed an obstacle".to_owned());
        }
        (self.pose_lost_s > MAX_SHARE_LOST * duration).then(|| {
            format!(
                "the pose was unknown or too uncertain to drive for {:.1} of {duration:.1} s: compare the signs and units of odometry and gyro, and the transforms of the sensors",
                self.pose_lost_s
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_that_located_itself_is_no_failure() {
        let by_images = SensorsRun { images_tracked: 30, pose_lost_s: 0.9, ..SensorsRun::default() };
        assert_eq!(by_images.failure(10.0), None);
        let by_laser = SensorsRun { scans_matched: 30, has_obstacles: true, ..SensorsRun::default() };
        assert_eq!(by_laser.failure(10.0), None);
    }

    #[test]
    fn a_robot_without_sight_or_pose_failed() {
        let failure = |run: SensorsRun| run.failure(10.0).unwrap_or_default();
        assert!(failure(SensorsRun::default()).contains("tracked no image"));
        assert!(failure(SensorsRun { scans_matched: 3, ..SensorsRun::default() }).contains("obstacle"));
        let lost = SensorsRun { images_tracked: 9, pose_lost_s: 1.1, ..SensorsRun::default() };
        assert!(
            failure(lost).starts_with("the pose was unknown or too uncertain to drive for 1.1 of 10.0 s")
        );
    }
}
