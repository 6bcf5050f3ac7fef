mod trip;

use crate::{body::WiredBody, failure::Failure, logbook::Logbook, tape::Tape, view::BestView};
use base64::prelude::{BASE64_STANDARD, Engine};
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};
use trip::Trip;
use trundle::core::{Pose2, RobotBody};
use trundle::runtime::{Histogram, Memory, Mission, Robot, RobotConfig, Task};
use trundle::sim::Simulator;

/// What a run is: recorded first, and all that a replay needs besides the events.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSetup {
    /// The room's name.
    pub scene: String,
    /// The seed of room and noise.
    pub seed: u64,
    /// What the robot shall do, map frame.
    pub mission: Mission,
    /// Moves truth into the map frame; for judges only.
    pub map_from_world: Pose2,
    /// Seconds of the robot's time after which the run is given up.
    pub time_limit: f64,
    /// The robot.
    pub robot: RobotConfig,
    /// Whether it gave its long work out, to threads beside the control loop.
    #[serde(default)]
    pub real_time: bool,
    /// What it woke up with, as base64 of [`Memory`]'s bytes; none: it began with an empty map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub woken: Option<String>,
}

impl RunSetup {
    /// The robot, with its mission begun.
    pub fn robot_at_work(&self) -> Result<Robot, Failure> {
        let Some(woken) = &self.woken else {
            let mut robot = Robot::new(self.robot.clone())?;
            robot.begin(&self.mission);
            return Ok(robot);
        };
        let unusable = |error: String| Failure::Input(format!("the memory cannot be used: {error}"));
        let bytes = BASE64_STANDARD.decode(woken).map_err(|error| unusable(error.to_string()))?;
        let memory = Memory::from_bytes(&bytes).map_err(|error| unusable(error.to_string()))?;
        waking(self, &memory)
    }

    /// The goal of a task, map frame; `None` for one that has none.
    pub fn goal_of(task: &Task) -> Option<Pose2> {
        match task {
            Task::Go(goal) => Some(*goal),
            Task::Return => Some(Pose2::IDENTITY),
            Task::Explore => None,
        }
    }

    /// The last goal of the mission.
    pub fn last_goal(&self) -> Option<Pose2> {
        self.mission.tasks().iter().rev().find_map(Self::goal_of)
    }
}

/// A run that has ended.
pub struct Run {
    /// The robot, with its map and plan.
    pub robot: Robot,
    /// What happened.
    pub log: Logbook,
    /// The view with the most tracked features.
    pub view: BestView,
    /// Wall-clock time of the whole, s.
    pub seconds: f64,
    /// What recording took.
    pub tape: TapeCost,
}

/// What recording took.
#[derive(Debug, Default)]
pub struct TapeCost {
    /// Lines that waited for the disk, each time one was put in.
    pub waiting: Histogram,
    /// Lines left out because the disk could not follow.
    pub lost: u64,
    /// Processor time of the thread that records, where there is one.
    pub spent: Duration,
    /// Why there is no whole recording, if there is none.
    pub failure: Option<Failure>,
}

/// The robot stands and is watched for so long after it has arrived, s: what still rolls counts.
const AFTERMATH: f64 = 0.5;

/// Lets the robot of `setup` live in `body` until it has arrived, given up, or its time is over; records everything, and notes it in
/// `log`.
pub fn drive(
    setup: &RunSetup,
    body: &mut dyn WiredBody,
    tape: Tape,
    log: Logbook,
    quiet: bool,
) -> Result<Run, Failure> {
    let mut trip = Trip::begin(setup, tape, log, quiet)?;
    let mut finished = None;
    while let Some(input) = body.next_input()? {
        let is_finished = trip.step(input, body)?;
        let now = trip.log.now;
        let is_over = is_finished && now - *finished.get_or_insert(now) >= AFTERMATH;
        if is_over || trip.is_interrupted || trip.log.elapsed() > setup.time_limit {
            break;
        }
    }
    trip.end(body)
}

/// Lets the robot of `setup` live in the simulator without recording: what the simulator says reaches it as it is. After
/// `restart` s it is switched off and on again where it stands, with nothing but the file that it kept last.
///
/// # Errors
/// When the robot has kept nothing by then, or the run is over before.
pub fn live(setup: &RunSetup, body: &mut Simulator, mut restart: Option<f64>) -> Result<Run, Failure> {
    let start = Instant::now();
    let mut robot = setup.robot_at_work()?;
    if restart.is_some() {
        robot = robot.remembering();
    }
    let mut kept = None;
    let mut log = Logbook::default();
    let mut finished = None;
    while let Some(event) = RobotBody::next_event(body)? {
        log.judge(&event, setup.map_from_world);
        log.true_contacts = Some(body.contacts());
        let report = robot.step(&event);
        if let Some(twist) = report.twist {
            RobotBody::command(body, twist)?;
        }
        log.note(event.stamp(), &report);
        let is_over = report.finished && log.now - *finished.get_or_insert(log.now) >= AFTERMATH;
        if is_over || log.elapsed() > setup.time_limit {
            break;
        }
        kept = report.memory.or(kept);
        if let Some(at) = restart.take_if(|at| log.elapsed() >= *at) {
            robot = woken_after_kill(setup, kept.as_deref(), at)?;
        }
    }
    if let Some(at) = restart {
        let ended = log.elapsed();
        return Err(Failure::Input(format!("the restart at {at} s: the run was over after {ended:.1} s")));
    }
    Ok(Run {
        robot,
        log,
        view: BestView::default(),
        seconds: start.elapsed().as_secs_f64(),
        tape: TapeCost::default(),
    })
}

/// The robot that is switched on after a kill at `at` s, with what was in its file.
fn woken_after_kill(setup: &RunSetup, kept: Option<&Memory>, at: f64) -> Result<Robot, Failure> {
    let kept =
        kept.ok_or_else(|| Failure::Input(format!("the restart at {at} s: nothing had been kept by then")))?;
    let woken = Some(BASE64_STANDARD.encode(kept.to_bytes()));
    RunSetup { woken, ..setup.clone() }.robot_at_work()
}

/// A robot that wakes up with a memory.
fn waking(setup: &RunSetup, memory: &Memory) -> Result<Robot, Failure> {
    Robot::waking(setup.robot.clone(), memory)
        .map_err(|error| Failure::Input(format!("the memory cannot be used: {error}")))
}
