//! A closed-loop run over real wires: a serial line to an emulated Kobuki and a stream of camera frames, by the wall clock.

use crate::simulated::{EmulatedRobot, simulated_real_time_body, time_limit};
use crate::trial::{Trial, TrialPlan};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use trundle_app::hardware::{OpenCamera, start_hardware};
use trundle_app::operator::FrontEnd;
use trundle_app::real_time::run_in_real_time;
use trundle_app::report::RunNumbers;
use trundle_app::{AppError, FinishedRun, RecordingContent, RunLog, RunSetup};
use trundle_core::{Pose2, Vector2};
use trundle_drivers::kobuki::PseudoTerminal;
use trundle_drivers::{BaseSpec, CameraSpec};
use trundle_eval::goal_error;
use trundle_io::OutputFolder;
use trundle_sim::Simulator;

/// Time between two points of the true path \[s\]. Source: ours.
const PATH_PERIOD_S: f64 = 0.1;

/// Executes one run over wires, with its front end. Faults of the computer are not simulated.
///
/// # Errors
/// When the plan cannot be carried out, or base or camera do not answer.
pub fn run_over_wires(plan: TrialPlan, front_end: FrontEnd) -> Result<Trial, AppError> {
    let TrialPlan { name, seed, scene, mission, robot, faults, .. } = plan;
    let (world_from_map, limit) = (scene.start, time_limit(&mission));
    let mut setup = RunSetup::new(&scene.name, mission, robot.with_seed(seed)).with_time_limit(limit);
    setup.seed = seed;
    setup.real_time = true;
    setup.recording = RecordingContent::None;
    let config = simulated_real_time_body(&setup.robot, faults)?;
    let simulator = Simulator::new(scene, config, seed).map_err(AppError::input)?;
    let folder = tempfile::tempdir().map_err(|error| failed("make a folder", &error))?;
    let emulation = Emulation::start(simulator, folder.path())?;
    let run = drive(&setup, folder.path(), front_end);
    let truth = emulation.stop()?;
    Ok(trial(&setup, &run?, (name, seed, world_from_map), &truth))
}

fn failed(what: &str, error: &dyn std::fmt::Display) -> AppError {
    AppError::Environment(format!("cannot {what}: {error}"))
}

fn port(folder: &Path) -> std::path::PathBuf {
    folder.join("kobuki")
}

fn camera(folder: &Path) -> std::path::PathBuf {
    folder.join("camera")
}

/// The robot, on the wires in `folder`.
fn drive(setup: &RunSetup, folder: &Path, front_end: FrontEnd) -> Result<FinishedRun, AppError> {
    let (base, camera) = (BaseSpec::Kobuki(Some(port(folder))), CameraSpec::Stream(camera(folder)));
    let output = OutputFolder::create(&folder.join("run"))?;
    let camera = OpenCamera::open(&camera)?;
    let start = |events, _place| {
        start_hardware(&base, camera, setup.robot.camera, events, std::time::Instant::now(), None)
    };
    let (run, _) = run_in_real_time(setup, start, &output, None, RunLog::default(), front_end)?;
    Ok(run)
}

/// The emulated robot in a separate thread.
struct Emulation {
    is_over: Arc<AtomicBool>,
    thread: JoinHandle<Result<Truth, AppError>>,
}

/// Truth, world frame.
struct Truth {
    /// Time, s, and pose.
    path: Vec<(f64, Pose2)>,
    pose: Pose2,
    contacts: u32,
}

impl Emulation {
    fn start(simulator: Simulator, folder: &Path) -> Result<Self, AppError> {
        let terminal = PseudoTerminal::open_at(&port(folder))
            .map_err(|error| failed("make a pseudo terminal", &error))?;
        let robot = EmulatedRobot::new(simulator, terminal, Some(&camera(folder)))?;
        let is_over = Arc::<AtomicBool>::default();
        let over = Arc::clone(&is_over);
        let thread = std::thread::Builder::new()
            .name("emulated robot".to_owned())
            .spawn(move || emulate(robot, &over))
            .map_err(|error| failed("start a thread", &error))?;
        Ok(Self { is_over, thread })
    }

    fn stop(self) -> Result<Truth, AppError> {
        self.is_over.store(true, Ordering::Relaxed);
        self.thread.join().map_err(|_| failed("emulate the robot", &"its thread has died"))?
    }
}

fn emulate(mut robot: EmulatedRobot, is_over: &AtomicBool) -> Result<Truth, AppError> {
    let mut path: Vec<(f64, Pose2)> = Vec::new();
    robot.run(|simulator| {
        let time = simulator.stamp().as_secs();
        if path.last().is_none_or(|(last, _)| time - last >= PATH_PERIOD_S) {
            path.push((time, simulator.true_pose()));
        }
        is_over.load(Ordering::Relaxed)
    })?;
    let simulator = robot.simulator();
    Ok(Truth { path, pose: simulator.true_pose(), contacts: simulator.contacts() })
}

fn trial(
    setup: &RunSetup,
    run: &FinishedRun,
    (name, seed, world_from_map): (String, u64, Pose2),
    truth: &Truth,
) -> Trial {
    let mut numbers = RunNumbers::of(setup, run);
    let at_end = world_from_map.inverse() * truth.pose;
    numbers.goal_error = setup.last_goal().and_then(|goal| goal_error(goal, at_end).ok());
    numbers.contacts = truth.contacts as usize;
    let to_world = |point: Vector2| world_from_map.transform(point);
    let planned = run.robot.plan().map(|plan| plan.trajectory.points()).unwrap_or_default();
    Trial {
        name,
        seed,
        world_from_map,
        numbers,
        driven: truth.path.iter().map(|(_, pose)| pose.position()).collect(),
        times: truth.path.iter().map(|(time, _)| *time).collect(),
        poses: Vec::new(),
        planned: planned.iter().map(|point| to_world(point.pose.position())).collect(),
        grid: run.robot.grid().clone(),
        changes: run.log.changes.clone(),
    }
}
