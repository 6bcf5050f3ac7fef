//! A run over a course of the MRPB benchmark.

use super::course::Course;
use super::metrics::Metrics;
use crate::RunResult;
use crate::laser_run::LaserRun;
use crate::shards::points;
use serde::{Deserialize, Serialize};
use trundle_core::{OccupancyGrid, Vector2, difference_of_angles};
use trundle_runtime::DriveState;

/// Distance from the goal within which the goal counts as reached \[m\]. Source: MRPB 1.0.
pub const GOAL_TOLERANCE_M: f64 = 0.2;
/// Heading difference within which the goal counts as reached \[rad\]. Source: MRPB 1.0.
pub const GOAL_TOLERANCE_RAD: f64 = 0.1;
/// Largest mean time of a control cycle \[ms\]. With more the run fails. Source: ours.
pub const MAX_MEAN_CYCLE_MS: f64 = 2.0;

/// A run over a course.
#[derive(Debug, Serialize, Deserialize)]
pub struct MrpbTrial {
    /// The course.
    pub(super) course: Course,
    /// Seed of the noise.
    pub(super) seed: u64,
    /// The benchmark's metrics.
    pub(super) metrics: Metrics,
    /// Number of contacts.
    pub(super) contacts: u32,
    /// True distance from the goal at the end, m.
    pub(super) distance: f64,
    /// True heading error at the end, rad.
    pub(super) turn: f64,
    /// Largest distance of the estimate from truth, m.
    pub(super) max_estimate_error: f64,
    /// The state at the end.
    pub(super) state: DriveState,
    /// Positions driven, world frame.
    #[serde(with = "points")]
    pub(super) driven: Vec<Vector2>,
    /// The map, map frame.
    pub(super) grid: OccupancyGrid,
}

impl RunResult for MrpbTrial {
    fn is_success(&self) -> bool {
        self.success()
    }

    fn sentence(&self) -> String {
        format!("{}, {:.2} m from the goal, {} contacts", self.state, self.distance, self.contacts)
    }
}

impl MrpbTrial {
    /// The trial of a finished run.
    pub(super) fn of(course: Course, seed: u64, run: LaserRun) -> Self {
        let end = *run.end();
        Self {
            metrics: Metrics::of(&run),
            contacts: end.contacts,
            distance: end.pose.distance(&course.goal),
            turn: difference_of_angles(end.pose.theta, course.goal.theta).abs(),
            max_estimate_error: run.worst_estimate(),
            driven: run.moments.iter().map(|m| m.pose.position()).collect(),
            grid: run.robot.grid().clone(),
            state: run.state,
            course,
            seed,
        }
    }

    /// Whether the robot arrived within the benchmark's tolerance.
    pub(super) fn reached(&self) -> bool {
        self.state == DriveState::Arrived
            && self.distance <= GOAL_TOLERANCE_M
            && self.turn <= GOAL_TOLERANCE_RAD
    }

    /// Whether the goal was reached without a contact, with control cycles short enough.
    pub(super) fn success(&self) -> bool {
        self.reached() && self.contacts == 0 && self.metrics.cycle_ms[0] <= MAX_MEAN_CYCLE_MS
    }
}
