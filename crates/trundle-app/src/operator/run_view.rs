//! What a run shows to its front ends.

use std::sync::Arc;

use trundle_core::{Battery, OccupancyGrid, Odometry, PoseEstimate, Scan, Stamp, Trajectory, Twist2};
use trundle_runtime::{DriveState, MotionHold, Task, TaskRecord};

/// State of a run after a step. Large parts are shared with earlier views in which they are the same.
#[derive(Debug, Clone)]
pub struct RunView {
    /// Time of the step.
    pub stamp: Stamp,
    /// `map_from_base`.
    pub estimate: PoseEstimate,
    /// `odom_from_base`; `None` before the first reading.
    pub odometry: Option<Odometry>,
    /// The last command.
    pub twist: Twist2,
    /// State of the robot; of the whole mission when it is over.
    pub state: DriveState,
    /// The mission.
    pub mission: MissionView,
    /// The battery; `None` where the body has not reported it.
    pub battery: Option<Battery>,
    /// The condition under which no wheel may turn.
    pub hold: Option<MotionHold>,
    /// The newest scan, base frame at its stamp.
    pub scan: Option<Arc<Scan>>,
    /// The newest plan, map frame.
    pub plan: Option<Arc<Trajectory>>,
    /// The map, at most one second old.
    pub map: Option<Arc<MapView>>,
}

/// A mission as a run shows it.
#[derive(Debug, Clone, Default)]
pub struct MissionView {
    /// The request that began it; 0 for the mission of the setup.
    pub id: u64,
    /// The present task.
    pub task: Option<Task>,
    /// The tasks that have ended.
    pub ended: Arc<Vec<TaskRecord>>,
    /// Whether all tasks have ended. An empty mission is not over.
    pub is_over: bool,
}

/// The map of a run.
#[derive(Debug, Clone)]
pub struct MapView {
    /// Number of scans that were drawn into it so far: maps of equal numbers are equal, where no loop was closed.
    pub revision: u64,
    /// The map.
    pub grid: OccupancyGrid,
}
