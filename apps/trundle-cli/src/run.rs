use crate::{body::WiredBody, console, failure::Failure, logbook::Logbook, view::BestView};
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};
use std::time::Instant;
use trundle::core::{FrameId, Pose2, RobotBody, SensorEvent, Stamp};
use trundle::io::{EncodedEvent, OutputFolder, PoseInFrame, PosesInFrame, Recorder};
use trundle::runtime::{Mission, Robot, RobotConfig, Stage, StepReport, Task};
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
}

impl RunSetup {
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
}

/// The robot stands and is watched for so long after it has arrived, s: what still rolls counts.
const AFTERMATH: f64 = 0.5;

/// Lets the robot of `setup` live in `body` until it has arrived, given up, or its time is over; records everything.
pub fn drive(
    setup: &RunSetup,
    body: &mut dyn WiredBody,
    folder: &OutputFolder,
    quiet: bool,
) -> Result<Run, Failure> {
    let start = Instant::now();
    let mut robot = Robot::new(setup.robot.clone())?;
    robot.begin(&setup.mission);
    let mut recorder = folder.recorder("recording.mcap")?;
    recorder.record_json("/config", "trundle.Config", Stamp::default(), setup)?;
    let mut log = Logbook::default();
    let mut view = BestView::default();
    let line = console::live_line(quiet);
    let mut finished = None;
    while let Some(encoded) = body.next_event()? {
        recorder.record_event(&encoded)?;
        let event = encoded.decode().map_err(|error| Failure::Input(error.to_string()))?;
        log.judge(&event, setup.map_from_world);
        let report = robot.step(&event);
        if let Some(twist) = report.twist {
            body.command(twist)?;
        }
        record(&mut recorder, &robot, &encoded, &report)?;
        log.note(event.stamp(), &report);
        if let SensorEvent::Rgbd(image) = event {
            show(&line, &log, &robot, start);
            view.offer(image, &robot, &report);
        }
        if report.finished && log.now - *finished.get_or_insert(log.now) >= AFTERMATH {
            break;
        }
        if log.elapsed() > setup.time_limit {
            break;
        }
    }
    line.finish_and_clear();
    recorder.finish()?;
    Ok(Run { robot, log, view, seconds: start.elapsed().as_secs_f64() })
}

/// Lets the robot of `setup` live in the simulator without recording: what the simulator says reaches it as it is.
pub fn live(setup: &RunSetup, body: &mut Simulator) -> Result<Run, Failure> {
    let start = Instant::now();
    let mut robot = Robot::new(setup.robot.clone())?;
    robot.begin(&setup.mission);
    let mut log = Logbook::default();
    let mut finished = None;
    while let Some(event) = RobotBody::next_event(body)? {
        log.judge(&event, setup.map_from_world);
        let report = robot.step(&event);
        if let Some(twist) = report.twist {
            RobotBody::command(body, twist)?;
        }
        log.note(event.stamp(), &report);
        let is_over = report.finished && log.now - *finished.get_or_insert(log.now) >= AFTERMATH;
        if is_over || log.elapsed() > setup.time_limit {
            break;
        }
    }
    Ok(Run { robot, log, view: BestView::default(), seconds: start.elapsed().as_secs_f64() })
}

fn record<W: std::io::Write + std::io::Seek>(
    recorder: &mut Recorder<W>,
    robot: &Robot,
    event: &EncodedEvent,
    report: &StepReport,
) -> Result<(), Failure> {
    let stamp = event.stamp();
    if let Some(twist) = report.twist {
        recorder.record_json("/twist", "trundle.Twist", stamp, &twist)?;
    }
    if let (Some(estimate), Some(_)) = (&report.estimate, &report.track) {
        let pose = PoseInFrame::planar(stamp, &FrameId::Map.to_string(), estimate.pose);
        recorder.record_json("/pose", PoseInFrame::SCHEMA, stamp, &pose)?;
    }
    if let (true, Some(plan)) = (report.replanned, robot.plan()) {
        let poses = plan.trajectory.points().iter().map(|point| point.pose);
        let poses = PosesInFrame::planar(stamp, &FrameId::Map.to_string(), poses);
        recorder.record_json("/trajectory", PosesInFrame::SCHEMA, stamp, &poses)?;
    }
    Ok(())
}

fn show(line: &ProgressBar, log: &Logbook, robot: &Robot, start: Instant) {
    let pose = robot.estimate().pose;
    let wall = start.elapsed().as_secs_f64();
    let rate = |stage: Stage| robot.times().runs(stage) as f64 / log.elapsed().max(0.1);
    line.set_message(format!(
        "{:5.1} s ({:.1}x)  pose {:6.2} {:6.2} m {:6.1} deg  {:<10}  slam {:4.1} Hz  map {:3.1} Hz  control {:4.1} Hz",
        log.elapsed(),
        log.elapsed() / wall.max(1e-3),
        pose.x,
        pose.y,
        pose.theta.to_degrees(),
        log.state.to_string(),
        rate(Stage::Slam),
        rate(Stage::Mapping),
        rate(Stage::Control),
    ));
    line.tick();
}
