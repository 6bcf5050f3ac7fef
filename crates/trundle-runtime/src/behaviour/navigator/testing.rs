//! Maps, robots and world states for the tests of the navigator.

use super::Navigator;
use crate::behaviour::path_search::PathSearch;
use crate::behaviour::state::{State, Wait};
use crate::config::RobotConfig;
use crate::mission::executor_config::MissionExecutorConfig;
use crate::pose_status::{PoseCertainty, PoseStatus};
use crate::reason::Reason;
use crate::world_state::{DynamicObstacles, WorldState};
use trundle_control::MotionSense;
use trundle_core::{Cell, OccupancyGrid, Pose2, PoseEstimate, Stamp, Twist2, Vector2};

/// Known floor, 6 x 4 m about (3, 2); cells with `hidden` are unknown.
pub(crate) fn floor(hidden: impl Fn(Vector2) -> bool) -> OccupancyGrid {
    let mut grid = OccupancyGrid::from_ascii(0.05, &vec![".".repeat(120); 80].join("\n")).unwrap();
    let geometry = *grid.geometry();
    for k in 0..geometry.len() {
        let cell = geometry.cell(k);
        if hidden(geometry.center(cell)) {
            grid.set(cell, Cell::Unknown);
        }
    }
    grid
}

pub(crate) fn navigator() -> Navigator {
    let config = RobotConfig::default();
    let footprint = config.footprint().unwrap();
    Navigator::new(&config, &footprint).unwrap()
}

/// The settings of [`navigator`].
pub(crate) fn settings() -> MissionExecutorConfig {
    RobotConfig::default().mission_executor
}

/// A pose without doubt.
pub(crate) const KNOWN_POSE: PoseStatus =
    PoseStatus { certainty: PoseCertainty::Known, is_contradicted: false, is_doubtful: false };

pub(crate) fn at_rest(grid: &OccupancyGrid, now: Stamp, pose: Pose2) -> WorldState<'_> {
    let covariance = nalgebra::Matrix3::from_diagonal_element(1e-6);
    WorldState {
        now,
        estimate: PoseEstimate { stamp: now, pose, twist: Twist2::ZERO, covariance },
        pose_status: KNOWN_POSE,
        grid,
        scan: None,
        seen: None,
        wheels: Some(now),
        hold: None,
        motion: MotionSense::Wheels,
        dynamic_obstacles: DynamicObstacles::default(),
        station: crate::world_state::StationState::default(),
        zones: crate::zones::ZoneView::default(),
    }
}

/// A wait since this stamp.
pub(crate) fn waiting(reason: Reason, held_since: Option<Stamp>) -> State {
    State::Wait(Wait {
        reason,
        search: PathSearch { held_since, ..PathSearch::default() },
        interrupted: None,
    })
}
