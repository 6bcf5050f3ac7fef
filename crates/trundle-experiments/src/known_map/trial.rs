//! A run on a given map.

use super::places::Course;
use crate::RunResult;
use crate::laser_run::LaserRun;
use crate::shards::points;
use serde::{Deserialize, Serialize};
use trundle_core::{OccupancyGrid, Pose2, Vector2, difference_of_angles};
use trundle_runtime::DriveState;

/// Distance from the goal up to which an arrival is right \[m\]. Source: ours, half the smallest play of the robot in a hall.
pub const GOAL_TOLERANCE_M: f64 = 0.05;
/// Error of the estimated position up to which a run is right, also if it exceeds three standard deviations \[m\]. Source: ours, two cells
/// of the map.
pub const ESTIMATE_TOLERANCE_M: f64 = 0.1;

/// A run on a given map.
#[derive(Debug, Serialize, Deserialize)]
pub struct KnownMapTrial {
    /// The kind of place.
    pub(super) place: String,
    /// Seed of place and noise.
    pub(super) seed: u64,
    /// Goal, map frame.
    pub(super) goal: Pose2,
    /// The state at the end.
    pub(super) state: DriveState,
    /// True distance from the goal at the end, m.
    pub(super) distance: f64,
    /// True heading error at the end, rad.
    pub(super) turn: f64,
    /// Largest distance of the estimate from truth, m.
    pub(super) max_estimate_error: f64,
    /// The same among the moments in which it exceeds three standard deviations, m.
    pub(super) max_unnoticed_error: f64,
    /// Number of contacts.
    pub(super) contacts: u32,
    /// Duration, s.
    pub(super) time: f64,
    /// True distance driven, m.
    pub(super) length: f64,
    /// Positions driven, map frame.
    #[serde(with = "points")]
    pub(super) driven: Vec<Vector2>,
    /// The robot's map at the end.
    pub(super) grid: OccupancyGrid,
}

impl RunResult for KnownMapTrial {
    fn is_success(&self) -> bool {
        self.is_right()
    }

    fn sentence(&self) -> String {
        format!("{}, {:.2} m from the goal, {} contacts", self.state, self.distance, self.contacts)
    }
}

impl KnownMapTrial {
    /// The trial of a finished run.
    pub(super) fn of(course: &Course, run: &LaserRun) -> Self {
        let (end, map_from_world) = (*run.end(), course.start.inverse());
        Self {
            place: course.place.name().to_owned(),
            seed: course.seed,
            goal: map_from_world * course.goal,
            state: run.state.clone(),
            distance: end.pose.distance(&course.goal),
            turn: difference_of_angles(end.pose.theta, course.goal.theta).abs(),
            max_estimate_error: run.worst_estimate(),
            max_unnoticed_error: run.worst_unnoticed_estimate(),
            contacts: end.contacts,
            time: end.time,
            length: run.path_length(),
            driven: run.moments.iter().map(|m| map_from_world.transform(m.pose.position())).collect(),
            grid: run.robot.grid().clone(),
        }
    }

    /// Whether the robot reports that it arrived.
    pub(super) fn has_arrived(&self) -> bool {
        self.state == DriveState::Arrived
    }

    /// Whether the robot reports an arrival farther than [`GOAL_TOLERANCE_M`] from the goal.
    pub(super) fn is_false_arrival(&self) -> bool {
        self.has_arrived() && self.distance > GOAL_TOLERANCE_M
    }

    /// Whether the estimate was farther than [`ESTIMATE_TOLERANCE_M`] and three standard deviations from the truth.
    pub(super) fn is_estimate_wrong(&self) -> bool {
        self.max_unnoticed_error > ESTIMATE_TOLERANCE_M
    }

    /// Whether nothing was touched, the estimate was never wrong, and no false arrival was reported.
    pub(super) fn is_right(&self) -> bool {
        self.contacts == 0 && !self.is_false_arrival() && !self.is_estimate_wrong()
    }

    pub(super) fn file_name(&self) -> String {
        format!("{}-seed-{}", self.place.replace(' ', "-"), self.seed)
    }
}
