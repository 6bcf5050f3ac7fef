use crate::run::{RunSetup, drive};
use crate::{Outcome, args::DemoArgs, console, failure::Failure, robot_file, run_output};
use trundle::core::{Invalid, Pose2};
use trundle::io::OutputFolder;
use trundle::runtime::RobotConfig;
use trundle::sim::{HeightBand, Scene, SimConfig, Simulator};

/// Seconds of the robot's time after which a demo is given up.
const TIME_LIMIT: f64 = 180.0;

/// `trundle demo`.
pub fn run(args: &DemoArgs) -> Result<Outcome, Failure> {
    let robot = robot_file::load(args.config.as_deref())?;
    let scene = Scene::by_name(&args.scene, args.seed)?;
    let setup = RunSetup {
        scene: scene.name.clone(),
        seed: args.seed,
        goal: args.goal.map_or_else(|| scene.start_from_goal(), |goal| goal.0),
        map_from_world: scene.start.inverse(),
        time_limit: TIME_LIMIT,
        robot: robot.with_seed(args.seed),
    };
    require_free(&scene, scene.start * setup.goal, &setup.robot)?;
    let mut body = Simulator::new(scene, simulated(&setup.robot)?, args.seed)
        .map_err(|error| Failure::Input(error.to_string()))?;
    let folder = OutputFolder::create(&args.out)?;
    if !args.common.quiet {
        let goal = setup.goal;
        console::say(&format!(
            "Room '{}', seed {}: to ({:.2} m, {:.2} m, {:.0} deg), {:.1} m away, on camera, wheels and gyro alone.",
            setup.scene,
            setup.seed,
            goal.x,
            goal.y,
            goal.theta.to_degrees(),
            goal.position().norm()
        ));
    }
    let run = drive(&setup, &mut body, &folder, args.common.quiet)?;
    run_output::write(&setup, &run, folder, args.common.quiet)
}

/// Refuses a goal that no robot could reach: outside the room, or where something stands.
fn require_free(scene: &Scene, world_from_goal: Pose2, robot: &RobotConfig) -> Result<(), Failure> {
    let (low, high) = scene.world.bounds();
    let Pose2 { x, y, .. } = world_from_goal;
    if !(low.x..=high.x).contains(&x) || !(low.y..=high.y).contains(&y) {
        return Err(Failure::Input(format!(
            "goal is outside the room '{}': at ({x:.2}, {y:.2}) m of its frame",
            scene.name
        )));
    }
    let body = SimConfig::default().kobuki;
    let band = HeightBand::new(body.step_over, body.height)?;
    let clearance = scene.world.clearance(&robot.footprint()?, world_from_goal, band)?;
    if clearance <= 0.0 {
        return Err(Failure::Input(format!(
            "goal is in an obstacle of the room '{}': {:.3} m too little room",
            scene.name, -clearance
        )));
    }
    Ok(())
}

/// The simulated body of a robot file: the same base and camera, with the simulator's noise.
fn simulated(robot: &RobotConfig) -> Result<SimConfig, Invalid> {
    let mut config = SimConfig {
        camera: robot.camera,
        base_from_camera: robot.mount.validated()?.base_from_camera(),
        ..SimConfig::default()
    };
    config.kobuki.drive = robot.drive;
    config.kobuki.footprint_radius = robot.footprint_radius;
    config.validated()
}
