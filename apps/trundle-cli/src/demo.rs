use crate::logbook::Logbook;
use crate::run::{RunSetup, drive};
use crate::sim::scene::SceneOptions;
use crate::tape::Tape;
use crate::{Outcome, args::DemoArgs, console, failure::Failure, real_time, robot_file, run_output, sim};
use base64::prelude::{BASE64_STANDARD, Engine};
use std::fmt::Display;
use std::path::Path;
use trundle::core::{Invalid, Pose2};
use trundle::io::OutputFolder;
use trundle::runtime::{Memory, Mission, RobotConfig, Task};
use trundle::sim::{FaultSchedule, HeightBand, Scene, SimConfig, Simulator};

/// Seconds of the robot's time after which a task is given up by whoever watches: looking for another way through seven rooms takes 5
/// minutes, and then it waits.
const TASK_LIMIT: f64 = 600.0;
/// And an exploration.
const EXPLORE_LIMIT: f64 = 1800.0;

/// `trundle demo`.
pub fn run(args: &DemoArgs) -> Result<Outcome, Failure> {
    let robot = robot_file::load(args.config.as_deref())?;
    let options =
        SceneOptions { seed: args.seed, up: args.up.axis(), start: args.start.map(|start| start.0) };
    let mut scene = sim::scene::load(&args.scene, options)?;
    let faults = args.faults.as_deref().map(sim::faults::read).transpose()?.unwrap_or_default();
    let woken = args.wake.and(args.memory.as_deref()).map(remembered).transpose()?;
    let mission = match &woken {
        Some((memory, _)) => memory.mission.left.clone(),
        None => mission(args, &scene)?,
    };
    let setup = RunSetup {
        scene: scene.name.clone(),
        seed: args.seed,
        map_from_world: scene.start.inverse(),
        time_limit: args.time_limit.unwrap_or_else(|| time_limit(&mission)),
        mission,
        robot: robot.with_seed(args.seed),
        real_time: args.real_time,
        woken: woken.map(|(_, bytes)| BASE64_STANDARD.encode(bytes)),
    };
    require_free("start", &scene, scene.start, &setup.robot)?;
    for goal in setup.mission.tasks().iter().filter_map(RunSetup::goal_of) {
        require_free("goal", &scene, scene.start * goal, &setup.robot)?;
    }
    scene.start = args.wake.map_or(scene.start, |wake| wake.0);
    let mut config = simulated(&setup.robot, faults)?;
    if args.real_time {
        config.camera_rate_hz = real_time::CAMERA_HZ;
        config.kobuki.command_timeout = real_time::COMMAND_TIMEOUT;
    }
    let mut body =
        Simulator::new(scene, config, args.seed).map_err(|error| Failure::Input(error.to_string()))?;
    let folder = OutputFolder::create(&args.out)?;
    if !args.common.quiet {
        let (scene, seed) = (&setup.scene, setup.seed);
        let mission = run_output::told(&setup.mission);
        console::say(&format!("Room '{scene}', seed {seed}, on camera, wheels and gyro alone: {mission}."));
    }
    if args.real_time {
        let (run, timing) = real_time::drive_live(
            &setup,
            body,
            &folder,
            args.memory.as_deref(),
            Logbook::default(),
            args.common.quiet,
        )?;
        return run_output::write(&setup, run, Some(&timing), folder, args.common.quiet);
    }
    let run = drive(
        &setup,
        &mut body,
        Tape::here(&folder)?.keeping(args.memory.as_deref())?,
        Logbook::default(),
        args.common.quiet,
    )?;
    run_output::write(&setup, run, None, folder, args.common.quiet)
}

/// What a robot kept in this file, and its bytes.
fn remembered(file: &Path) -> Result<(Memory, Vec<u8>), Failure> {
    let refused = |error: &dyn Display| Failure::Input(format!("{}: {error}", file.display()));
    let bytes = std::fs::read(file).map_err(|error| refused(&error))?;
    let memory = Memory::from_bytes(&bytes).map_err(|error| refused(&error))?;
    if memory.mission.left.tasks().is_empty() {
        return Err(refused(&"nothing is left of its mission: the run that kept it came to its end"));
    }
    Ok((memory, bytes))
}

/// The goals asked for, or the room's own; before them exploration and after them the way back, unless it is to be direct.
fn mission(args: &DemoArgs, scene: &Scene) -> Result<Mission, Invalid> {
    let mut goals: Vec<Task> = args.goal.iter().map(|goal| Task::Go(goal.0)).collect();
    if goals.is_empty() {
        goals.push(Task::Go(scene.start_from_goal()));
    }
    if args.direct {
        return Mission::new(goals);
    }
    Mission::new([vec![Task::Explore], goals, vec![Task::Return]].concat())
}

/// After so many seconds of the robot's time whoever watches loses patience.
pub fn time_limit(mission: &Mission) -> f64 {
    let limit = |task: &Task| if *task == Task::Explore { EXPLORE_LIMIT } else { TASK_LIMIT };
    mission.tasks().iter().map(limit).sum()
}

/// Refuses a place (`name`d, world frame) where no robot can stand: outside the room, or where something stands.
pub fn require_free(name: &str, scene: &Scene, place: Pose2, robot: &RobotConfig) -> Result<(), Failure> {
    let (low, high) = scene.world.bounds();
    let Pose2 { x, y, .. } = place;
    if !(low.x..=high.x).contains(&x) || !(low.y..=high.y).contains(&y) {
        return Err(Failure::Input(format!(
            "{name} is outside the room '{}': at ({x:.2}, {y:.2}) m of its frame",
            scene.name
        )));
    }
    let body = SimConfig::default().kobuki;
    let band = HeightBand::new(body.step_over, body.height)?;
    let clearance = scene.world.clearance(&robot.footprint()?, place, band)?;
    if clearance <= 0.0 {
        return Err(Failure::Input(format!(
            "{name} is in an obstacle of the room '{}': {:.3} m too little room",
            scene.name, -clearance
        )));
    }
    Ok(())
}

/// The simulated body of a robot file: the same base and camera, with the simulator's noise.
pub fn simulated(robot: &RobotConfig, faults: FaultSchedule) -> Result<SimConfig, Invalid> {
    let mut config = SimConfig {
        camera: robot.camera,
        faults,
        base_from_camera: robot.mount.validated()?.base_from_camera(),
        ..SimConfig::default()
    };
    config.kobuki.drive = robot.drive;
    config.kobuki.footprint_radius = robot.footprint_radius;
    config.kobuki.footprint = robot.footprint.clone();
    config.validated()
}
