//! `trundle ros2`: a ROS 2 robot, its sensors and base by topics.

mod args;

pub use args::{Ros2Args, RosArgs};

use crate::outcome::Outcome;
use crate::run::RunArgs;
use crate::{console, logging, run_output};
use std::time::{Duration, Instant};
use trundle::app::operator::{FrontEnd, OperatorLink};
use trundle::app::real_time::run_in_real_time;
use trundle::app::report::mission_text;
use trundle::app::{AppError, Progress, RunLog, RunSetup, read_mission, stop};
use trundle::ros2::body::BodySettings;
use trundle::ros2::{RobotNode, Ros2Error, Ros2Robot};
use trundle::runtime::{Mission, RobotConfig, Task};

/// `trundle ros2`.
pub fn run(args: &Ros2Args) -> Result<Outcome, AppError> {
    let mut robot = args.robot.robot()?;
    let options = args.ros.options()?;
    let mission = mission(args)?;
    let settings = BodySettings {
        use_sim_time: options.use_sim_time,
        stamped_commands: options.stamped_commands,
        base_frame: options.frames.base.clone(),
        ..args.topics()
    };
    let wait = Duration::from_secs_f64(args.wait);
    let is_cancelled = || stop::is_requested(|| "the wait for topics".to_owned());
    let connected =
        Ros2Robot::connect(&options, settings, &mut robot, wait, is_cancelled).map_err(refused)?;
    let (node, link, body) = connected.into_parts();
    let mut setup = RunSetup::new(&options.node.names.node, mission, robot).by_command("ros2");
    setup.time_limit = args.time_limit.unwrap_or(f64::MAX);
    setup.real_time = true;
    setup.is_operated = args.stays();
    setup.recording = args.record.content();
    let folder = logging::output_folder(&args.out)?;
    if !args.common.quiet {
        let mission = if args.stays() {
            "waits for goals; Ctrl-C ends it".to_owned()
        } else {
            mission_text(&setup.mission)
        };
        console::print(&format!(
            "ROS 2 domain {}, node {}: {mission}.",
            options.node.domain, options.node.names.node
        ));
    }
    let (line, progress) = console::progress(args.common.quiet);
    let log = if args.stays() { RunLog::brief() } else { RunLog::default() };
    let start = |events, _place| body.start(events);
    let run =
        run_in_real_time(&setup, start, &folder, args.checkpoint.as_deref(), log, front_end(progress, link));
    line.finish_and_clear();
    drop(node);
    let (run, timing) = run?;
    run_output::write(&setup, run, Some(&timing), folder, args.common.quiet)
}

/// What accompanies a run with ROS 2.
fn front_end(progress: Progress, link: OperatorLink) -> FrontEnd {
    FrontEnd { progress, operator: Some(link) }
}

/// ROS 2 beside `trundle run`, where it is asked for.
pub fn beside(
    args: &RunArgs,
    robot: &RobotConfig,
    origin: Instant,
    progress: Progress,
) -> Result<(Option<RobotNode>, FrontEnd), AppError> {
    if !args.ros2 {
        return Ok((None, progress.into()));
    }
    let (node, link) = RobotNode::offer(&args.ros.options()?, robot, origin).map_err(refused)?;
    Ok((Some(node), front_end(progress, link)))
}

/// The error of a network or of topics.
pub fn refused(error: Ros2Error) -> AppError {
    AppError::Input(error.to_string())
}

fn mission(args: &Ros2Args) -> Result<Mission, AppError> {
    if let Some(file) = &args.mission {
        return read_mission(file);
    }
    let mut tasks: Vec<Task> = args.goal.iter().map(|goal| Task::Go(goal.0)).collect();
    if args.explore {
        tasks = vec![Task::Explore, Task::Return];
    }
    if tasks.is_empty() { Ok(Mission::default()) } else { Ok(Mission::new(tasks)?) }
}
