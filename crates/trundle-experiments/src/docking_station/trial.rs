//! A run with the charging station as its goal.

use crate::laser_run::{LaserPlan, LaserRun, drive, hokuyo};
use crate::simulated::simulated_body;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use trundle_app::AppError;
use trundle_app::operator::OperatorLink;
use trundle_core::{Pose2, difference_of_angles};
use trundle_runtime::{DriveState, Mission, RangeSource, RobotConfig, Task};
use trundle_sim::{FaultSchedule, Scene, SimConfig};

/// Time limit of a run \[s\]. Source: ours.
const TIME_LIMIT_S: f64 = 600.0;

/// The plan of a run with the charging station as its goal.
pub struct DockPlan {
    /// The place with its station, if any, and the robot's start.
    pub scene: Scene,
    /// The robot.
    pub robot: RobotConfig,
    /// Simulated body of the robot.
    pub body: SimConfig,
    /// The mission, map frame.
    pub mission: Mission,
    /// Seed of all noise.
    pub seed: u64,
}

/// Result of a run.
#[derive(Debug, Serialize, Deserialize)]
pub struct DockTrial {
    /// True pose of the base in the station's frame at the end; identity without a station.
    pub station_from_base: Pose2,
    /// Number of separate contacts: a correct dock has none, because the plates are ahead of the bumper.
    pub contacts: u32,
    /// Time, s.
    pub time: f64,
    /// State at the end.
    pub state: DriveState,
    /// Whether the battery charges at the end.
    pub is_charging: bool,
    /// Distance driven, m.
    pub path_length: f64,
}

impl DockTrial {
    /// Whether the robot is docked.
    #[must_use]
    pub fn is_docked(&self) -> bool {
        self.state == DriveState::Arrived && self.is_charging
    }

    /// Lateral distance from the station's axis, m.
    #[must_use]
    pub fn lateral_error(&self) -> f64 {
        self.station_from_base.y
    }

    /// Heading error, rad.
    #[must_use]
    pub fn heading_error(&self) -> f64 {
        difference_of_angles(self.station_from_base.theta, PI)
    }
}

/// The simulated body of a robot, with a camera, or with a laser instead if the laser is the range source.
///
/// # Errors
/// When a number of the robot is outside its range.
pub fn body_of(robot: &RobotConfig) -> Result<SimConfig, AppError> {
    let mut body = simulated_body(robot, FaultSchedule::default())?;
    if robot.sight == RangeSource::Laser {
        body.has_camera = false;
        body.laser = Some(hokuyo(0.0));
    }
    Ok(body)
}

/// Executes a run, displayed to viewers of `watch`. Returns its result and the whole run.
///
/// # Errors
/// When a number of the plan is outside its range, or the start is not free.
pub fn dock(plan: DockPlan, watch: Option<OperatorLink>) -> Result<(DockTrial, LaserRun), AppError> {
    let DockPlan { scene, robot, body, mission, seed } = plan;
    let station = scene.station;
    let run = drive(
        LaserPlan { robot, body, scene, mission, known: None, seed, time_limit: TIME_LIMIT_S },
        watch,
        |_| false,
    )?;
    let end = *run.end();
    let trial = DockTrial {
        station_from_base: station.map_or(Pose2::IDENTITY, |station| station.inverse() * end.pose),
        contacts: end.contacts,
        time: end.time,
        state: run.state.clone(),
        is_charging: run.robot.battery().is_some_and(|battery| battery.is_charging),
        path_length: run.path_length(),
    };
    Ok((trial, run))
}

/// The mission of docking alone.
///
/// # Errors
/// Never: the task has no goal.
pub fn docking_alone() -> Result<Mission, AppError> {
    Ok(Mission::new(vec![Task::Dock])?)
}
