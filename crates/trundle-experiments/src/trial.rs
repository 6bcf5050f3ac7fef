//! Parallel closed-loop runs of robot and simulator.

use crate::RunsRequest;
use crate::experiment_context::ExperimentContext;
use crate::experiment_display::RunResult;
use crate::run_each::run_each;
use crate::shards::points;
use crate::simulated::{simulated_body, time_limit};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::time::Instant;
use trundle_app::operator::{FrontEnd, OperatorLink};
use trundle_app::report::{RunNumbers, state_log};
use trundle_app::{
    AFTER_ARRIVAL_S, AppError, BestView, FinishedRun, PoseSample, Progress, RecordingCost, RunLog,
    RunRecorder, RunSetup, StateChange, run_on_body, stop,
};
use trundle_core::{OccupancyGrid, Pose2, RobotBody, Vector2};
use trundle_runtime::{Checkpoint, Mission, Robot, RobotConfig};
use trundle_sim::{FaultSchedule, Scene, Simulator};
use trundle_viz::Table;

/// Maximum number of run names in a message. Source: ours.
const MAX_LISTED_NAMES: usize = 30;

/// The plan of a closed-loop run: robot and simulator with noise, without truth in the loop.
pub struct TrialPlan {
    /// Name in tables.
    pub name: String,
    /// The seed of all noise and of the scene.
    pub seed: u64,
    /// The room, with the robot's start.
    pub scene: Scene,
    /// The mission, in the robot's map frame.
    pub mission: Mission,
    /// The robot.
    pub robot: RobotConfig,
    /// Faults of the simulated robot.
    pub faults: FaultSchedule,
    /// Fault of the computer.
    pub computer_fault: Option<ComputerFault>,
    /// Images per second; `None` for the rate of [`trundle_sim::SimConfig`].
    pub camera_rate_hz: Option<f64>,
}

impl TrialPlan {
    /// A run without faults.
    #[must_use]
    pub fn new(name: &str, seed: u64, scene: Scene, mission: Mission, robot: &RobotConfig) -> Self {
        Self {
            name: name.to_owned(),
            seed,
            scene,
            mission,
            robot: robot.clone(),
            faults: FaultSchedule::default(),
            computer_fault: None,
            camera_rate_hz: None,
        }
    }

    /// Name and seed: `lights out, seed 2`.
    #[must_use]
    pub fn label(&self) -> String {
        format!("{}, seed {}", self.name, self.seed)
    }
}

impl RunResult for Trial {
    fn is_success(&self) -> bool {
        self.numbers.is_success()
    }

    fn sentence(&self) -> String {
        self.numbers.verdict()
    }
}

/// A fault of the robot's computer.
#[derive(Debug, Clone, Copy)]
pub enum ComputerFault {
    /// The program is killed after this time, s, and restarted from its last checkpoint, which may be seconds old.
    Restart(f64),
    /// The disk is full.
    FullDisk,
}

/// Result of a trial.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Trial {
    /// Name in tables.
    pub name: String,
    /// The seed.
    pub seed: u64,
    /// Pose of the map frame in the world frame.
    pub world_from_map: Pose2,
    /// The numbers.
    pub numbers: RunNumbers,
    /// True path, world frame.
    #[serde(with = "points")]
    pub driven: Vec<Vector2>,
    /// Time at each of these points, s since the beginning.
    pub times: Vec<f64>,
    /// Estimated and true pose at every image.
    pub poses: Vec<PoseSample>,
    /// The last planned trajectory, world frame.
    #[serde(with = "points")]
    pub planned: Vec<Vector2>,
    /// The map, map frame.
    pub grid: OccupancyGrid,
    /// Changes of state, in order.
    pub changes: Vec<StateChange>,
}

impl Trial {
    /// Changes of state, in order.
    pub fn state_table(&self) -> Table {
        state_log(&format!("{}, seed {}", self.name, self.seed), &self.changes)
    }
}

/// The plans selected by the request.
///
/// # Errors
/// When no plan is selected; the error names the available ones.
pub fn selected(mut plans: Vec<TrialPlan>, request: &RunsRequest) -> Result<Vec<TrialPlan>, AppError> {
    let names: BTreeSet<String> = plans.iter().map(|plan| plan.name.clone()).collect();
    if let Some(word) = &request.only {
        plans.retain(|plan| plan.label().contains(word.as_str()));
    }
    if plans.is_empty() {
        let word = request.only.as_deref().unwrap_or_default();
        let first = names.iter().take(MAX_LISTED_NAMES).cloned().collect::<Vec<_>>().join("', '");
        let more = if names.len() > MAX_LISTED_NAMES { ", ..." } else { "" };
        let problem = format!("--only {word}: no run has a name that holds this; there are '{first}'{more}");
        return Err(AppError::Input(problem));
    }
    Ok(plans)
}

/// Executes the runs, one per thread; the results are in the order of the plans.
///
/// # Errors
/// That of the first plan that cannot be executed.
pub fn run_all(
    plans: Vec<TrialPlan>,
    request: &RunsRequest,
    context: &ExperimentContext,
) -> Result<Vec<Trial>, AppError> {
    let name_of = |plan: &TrialPlan| plan.label();
    run_each(selected(plans, request)?, "runs", context, name_of, run_one)
}

/// Executes one run, displayed to the viewers of `watch`.
///
/// # Errors
/// When the plan cannot be executed.
pub fn run_one(plan: TrialPlan, watch: Option<OperatorLink>) -> Result<Trial, AppError> {
    let TrialPlan { name, seed, scene, mission, robot, faults, computer_fault, camera_rate_hz } = plan;
    let world_from_map = scene.start;
    let limit = time_limit(&mission);
    let mut setup = RunSetup::new(&scene.name, mission, robot.with_seed(seed)).with_time_limit(limit);
    setup.seed = seed;
    setup.map_from_world = world_from_map.inverse();
    let mut config = simulated_body(&setup.robot, faults)?;
    config.camera_rate_hz = camera_rate_hz.unwrap_or(config.camera_rate_hz);
    let mut body = Simulator::new(scene, config, seed).map_err(|error| AppError::Input(error.to_string()))?;
    let run = match computer_fault {
        None => run_unrecorded(&setup, &mut body, None, watch),
        Some(ComputerFault::Restart(at)) => run_unrecorded(&setup, &mut body, Some(at), watch)
            .map_err(|error| AppError::Input(format!("{name}, seed {seed}: {error}"))),
        Some(ComputerFault::FullDisk) => run_on_body(
            &setup,
            &mut body,
            RunRecorder::onto_full_disk()?,
            RunLog::default(),
            FrontEnd { progress: Progress::hidden(), operator: watch },
        ),
    }?;
    let planned = planned(&run);
    Ok(Trial {
        name,
        seed,
        world_from_map,
        numbers: RunNumbers::of(&setup, &run),
        times: run.log.truths.iter().map(|(stamp, _)| *stamp - run.log.start.unwrap_or_default()).collect(),
        poses: run.log.pose_samples(),
        driven: run.log.truths.iter().map(|(_, pose)| world_from_map.transform(pose.position())).collect(),
        planned: planned.into_iter().map(|point| world_from_map.transform(point)).collect(),
        grid: run.robot.grid().clone(),
        changes: run.log.changes.clone(),
    })
}

fn planned(run: &FinishedRun) -> Vec<Vector2> {
    let points = run.robot.plan().map(|plan| plan.trajectory.points());
    points.unwrap_or_default().iter().map(|point| point.pose.position()).collect()
}

fn is_stopped(log: &RunLog) -> bool {
    stop::is_requested(|| format!("{:.1} s of a run", log.elapsed()))
}

/// Runs the robot of `setup` in the simulator without recording and without encoding of images. After `restart` s the robot restarts at its
/// place from its last checkpoint.
///
/// # Errors
/// When the robot has no checkpoint at that time, or the run ends earlier.
fn run_unrecorded(
    setup: &RunSetup,
    body: &mut Simulator,
    mut restart: Option<f64>,
    mut watch: Option<OperatorLink>,
) -> Result<FinishedRun, AppError> {
    let start = Instant::now();
    let mut robot = setup.start_robot()?;
    if restart.is_some() {
        robot = robot.with_checkpoints();
    }
    let mut checkpoint = None;
    let mut log = RunLog::default();
    let mut finished = None;
    if let Some(link) = &mut watch {
        link.note_camera(&setup.robot.camera);
    }
    while let Some(event) = RobotBody::next_event(body).map_err(AppError::input)? {
        log.on_event(&event, setup.map_from_world);
        log.true_contacts = Some(body.contacts());
        let report = robot.step(&event);
        if let Some(twist) = report.twist {
            RobotBody::command(body, twist).map_err(AppError::input)?;
        }
        log.on_report(event.stamp(), &report);
        if let Some(link) = &mut watch {
            link.note_event(&event);
            link.publish(event.stamp(), &robot, &report);
        }
        let is_over = report.finished && log.now - *finished.get_or_insert(log.now) >= AFTER_ARRIVAL_S;
        if is_over || log.elapsed() > setup.time_limit || is_stopped(&log) {
            break;
        }
        checkpoint = report.checkpoint.or(checkpoint);
        if let Some(at) = restart.take_if(|at| log.elapsed() >= *at) {
            robot = resumed_after_kill(setup, checkpoint.as_deref(), at)?;
        }
    }
    if let Some(at) = restart {
        let ended = log.elapsed();
        return Err(AppError::Input(format!("the restart at {at} s: the run was over after {ended:.1} s")));
    }
    Ok(FinishedRun {
        robot,
        log,
        earlier_tasks: Vec::new(),
        view: BestView::default(),
        seconds: start.elapsed().as_secs_f64(),
        recording: RecordingCost::default(),
        cut: None,
    })
}

/// The robot restarted from its last checkpoint after a kill at `at` s.
fn resumed_after_kill(setup: &RunSetup, checkpoint: Option<&Checkpoint>, at: f64) -> Result<Robot, AppError> {
    let checkpoint = checkpoint.ok_or_else(|| {
        AppError::Input(format!("the restart at {at} s: no checkpoint had been made by then"))
    })?;
    setup.clone().resumed_from(&checkpoint.to_bytes()).start_robot()
}

#[cfg(test)]
pub(crate) mod fixtures {
    //! Finished runs for the tests of verdicts and tables.

    use super::*;
    use trundle_app::TrackCounts;
    use trundle_app::report::{RunEnd, TaskCounts};
    use trundle_eval::goal_error;
    use trundle_runtime::DriveState;

    /// A run that arrived with this offset from its goal (m, m, rad) and this number of contacts.
    pub fn arrived(name: &str, seed: u64, (dx, dy, dtheta): (f64, f64, f64), contacts: usize) -> Trial {
        let error = goal_error(Pose2::IDENTITY, Pose2::new(dx, dy, dtheta)).unwrap();
        let numbers = RunNumbers {
            goals: Vec::new(),
            goals_asked: Some(1),
            goal_error: Some(error),
            believed_error: Some(error),
            estimate_rmse: Some(0.01),
            contacts,
            path_length: 3.0,
            duration: 20.0,
            plans: 1,
            tracked: TrackCounts::default(),
            landmarks: 0,
            keyframes: 0,
            images_dropped: Vec::new(),
            docking: None,
            end: RunEnd {
                state: DriveState::Arrived,
                is_operated: false,
                of_sensors: None,
                out_of_time: None,
                allowed: trundle_app::report::GoalOutcome::exact(),
                tasks: TaskCounts::default(),
            },
        };
        let line = vec![Vector2::zeros(), Vector2::new(1.0, 0.0)];
        Trial {
            name: name.to_owned(),
            seed,
            world_from_map: Pose2::IDENTITY,
            numbers,
            driven: line.clone(),
            times: vec![0.0, 2.0],
            poses: Vec::new(),
            planned: line,
            grid: OccupancyGrid::from_ascii(0.5, "..\n..").unwrap(),
            changes: Vec::new(),
        }
    }

    /// A run that did not arrive.
    pub fn under_way(name: &str, seed: u64) -> Trial {
        let mut trial = arrived(name, seed, (1.0, 0.0, 0.0), 0);
        trial.numbers.end.state = DriveState::Idle;
        trial
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_that_no_run_holds_is_refused_with_the_names() {
        let plan = |name: &str| {
            let scene = Scene::by_name("room", 1).unwrap();
            let mission = Mission::new(vec![trundle_runtime::Task::Return]).unwrap();
            TrialPlan::new(name, 1, scene, mission, &RobotConfig::default())
        };
        let only = Some("no such run".to_owned());
        let request = RunsRequest { seeds: 1, only, robot: RobotConfig::default() };
        let refused = run_all(vec![plan("one"), plan("two")], &request, &ExperimentContext::default());
        let text = refused.err().unwrap().to_string();
        assert!(text.contains("no such run") && text.ends_with("there are 'one', 'two'"), "{text}");
    }

    #[test]
    fn the_table_of_states_has_a_row_for_each_change() {
        let mut trial = fixtures::arrived("1", 4, (0.0, 0.0, 0.0), 0);
        let (state, pose) = (trundle_runtime::DriveState::Arrived, Pose2::new(1.0, 2.0, 0.0));
        let transition = Some(trundle_runtime::TransitionReason::GoalReached);
        trial.changes = vec![StateChange { at: 12.5, state, transition, pose }];
        let html = trundle_viz::Report::new("x").table(trial.state_table()).to_html();
        assert!(html.contains("1, seed 4") && html.contains("12.5") && html.contains("1.00, 2.00, 0"));
        assert!(html.contains("<td>arrived</td><td>the goal is reached</td>"), "{html}");
    }
}
