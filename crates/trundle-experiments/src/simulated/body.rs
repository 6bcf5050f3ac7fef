//! The simulated body of a robot, and checks of start, goals and time.

use trundle_app::AppError;
use trundle_app::real_time::{CAMERA_HZ, COMMAND_TIMEOUT_S};
use trundle_core::{Invalid, Pose2};
use trundle_runtime::{Mission, RobotConfig, Task};
use trundle_sim::{FaultSchedule, HeightBand, Scene, SimConfig};

/// Time limit of a task, simulated time \[s\]. A search for another path through seven rooms takes 300 s, before a wait. Source: ours.
const TASK_LIMIT_S: f64 = 600.0;
/// Time limit of an exploration, simulated time \[s\]. Source: ours.
const EXPLORE_LIMIT_S: f64 = 1800.0;

/// Time limit of a mission, simulated time \[s\].
#[must_use]
pub fn time_limit(mission: &Mission) -> f64 {
    let limit = |task: &Task| if *task == Task::Explore { EXPLORE_LIMIT_S } else { TASK_LIMIT_S };
    mission.tasks().iter().map(limit).sum()
}

/// Refuses a pose (world frame, called `name` in messages) outside the scene or in an obstacle.
///
/// # Errors
/// Names the pose, the scene and the distance.
pub fn require_free(name: &str, scene: &Scene, pose: Pose2, robot: &RobotConfig) -> Result<(), AppError> {
    let (low, high) = scene.world.bounds();
    let Pose2 { x, y, .. } = pose;
    if !(low.x..=high.x).contains(&x) || !(low.y..=high.y).contains(&y) {
        return Err(AppError::Input(format!(
            "{name} is outside the room '{}': at ({x:.2}, {y:.2}) m of its frame; the room is x {:.2} to {:.2} m, y {:.2} to {:.2} m",
            scene.name, low.x, high.x, low.y, high.y
        )));
    }
    let body = SimConfig::default().kobuki;
    let band = HeightBand::new(body.step_over, body.height)?;
    let clearance = scene.world.clearance(&robot.footprint()?, pose, band)?;
    if clearance <= 0.0 {
        return Err(AppError::Input(format!(
            "{name} is in an obstacle of the room '{}': {:.3} m too little room",
            scene.name, -clearance
        )));
    }
    Ok(())
}

/// The simulated body of a robot: the same base and camera, with the simulator's noise.
///
/// # Errors
/// When a number of the robot is outside its range.
pub fn simulated_body(robot: &RobotConfig, faults: FaultSchedule) -> Result<SimConfig, Invalid> {
    let mut config = SimConfig::default();
    config.camera = robot.camera;
    config.faults = faults;
    config.base_from_camera = robot.mount.validated()?.base_from_camera();
    config.kobuki.drive = robot.drive;
    config.kobuki.footprint_radius = robot.footprint_radius;
    config.kobuki.footprint = robot.footprint.clone();
    config.validated()
}

/// The simulated body of a robot for a run in real time.
///
/// # Errors
/// When a number of the robot is outside its range.
pub fn simulated_real_time_body(robot: &RobotConfig, faults: FaultSchedule) -> Result<SimConfig, Invalid> {
    let mut config = simulated_body(robot, faults)?;
    config.camera_rate_hz = CAMERA_HZ;
    config.kobuki.command_timeout = COMMAND_TIMEOUT_S;
    Ok(config)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn explorations_have_more_time_than_goals() {
        let mission = |tasks| Mission::new(tasks).unwrap();
        assert_eq!(time_limit(&mission(vec![Task::Return])), TASK_LIMIT_S);
        assert_eq!(time_limit(&mission(vec![Task::Explore, Task::Return])), EXPLORE_LIMIT_S + TASK_LIMIT_S);
    }

    #[test]
    fn a_pose_must_be_in_the_scene_and_free() {
        let (scene, robot) = (Scene::by_name("demo", 1).unwrap(), RobotConfig::default());
        require_free("start", &scene, scene.start, &robot).unwrap();
        let far = require_free("goal", &scene, Pose2::new(99.0, 0.0, 0.0), &robot).unwrap_err().to_string();
        assert!(far.starts_with("goal is outside the room 'demo'"), "{far}");
    }

    #[test]
    fn a_real_time_body_stops_without_commands() {
        let config = simulated_real_time_body(&RobotConfig::default(), FaultSchedule::default()).unwrap();
        assert_eq!((config.camera_rate_hz, config.kobuki.command_timeout), (CAMERA_HZ, COMMAND_TIMEOUT_S));
    }
}
