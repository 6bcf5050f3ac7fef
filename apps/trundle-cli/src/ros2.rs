//! `trundle ros2`: a ROS 2 robot, its sensors and base by topics.

mod args;

pub use args::Ros2Args;

use crate::outcome::Outcome;
use crate::{console, logging, run_output};
use std::time::Duration;
use trundle::app::real_time::run_in_real_time;
use trundle::app::{AppError, first_mission, keep_other_checkpoint, stop};
use trundle::ros2::Ros2Robot;

/// `trundle ros2`.
pub fn run(args: &Ros2Args) -> Result<Outcome, AppError> {
    let mut robot = args.options.robot.robot()?;
    let options = args.ros.options()?;
    let (mission, resumed) = first_mission(&args.request(), args.resume.as_deref(), args.stays())?;
    let wait = Duration::from_secs_f64(args.wait);
    let is_cancelled = || stop::is_requested(|| "the wait for topics".to_owned());
    let connected =
        Ros2Robot::connect(&options, args.topics.settings(&options), &mut robot, wait, is_cancelled)?;
    let (node, link, body) = connected.into_parts();
    let mut setup = args.options.setup("ros2", &options.node.names.node, mission, robot)?;
    setup.is_operated = args.stays();
    let setup = resumed.iter().fold(setup, |setup, bytes| setup.resumed_from(bytes));
    let setup = args.live.with_zones(setup)?;
    let folder = logging::output_folder(&args.out)?;
    if !args.options.common.quiet {
        console::print(&options.node.announcement(&setup.mission_line()));
    }
    let (line, progress) = console::progress(args.options.common.quiet);
    let log = setup.log();
    let (page, front_end) = args.live.front_ends(&setup, progress, Some(link), true)?;
    let checkpoint = args.options.checkpoint.as_deref();
    let start = |events, _place| {
        let body = body.start(events)?;
        keep_other_checkpoint(checkpoint, args.resume.as_deref()).map(|()| body)
    };
    let run = run_in_real_time(&setup, start, &folder, checkpoint, log, front_end);
    line.finish_and_clear();
    drop((page, node));
    let (run, timing) = run?;
    run_output::write(&setup, run, Some(&timing), folder, args.options.common.quiet)
}
