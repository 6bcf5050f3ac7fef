//! `trundle run`: a mission on a real robot.

mod args;
mod check;

pub use args::RunArgs;
#[cfg(feature = "ros2")]
pub use args::RunOptions;

use crate::outcome::Outcome;
use crate::{console, logging, run_output};
use std::time::Instant;
use trundle::app::hardware::{OpenCamera, start_hardware};
use trundle::app::real_time::run_in_real_time;
use trundle::app::{AppError, RUN_COMMAND, RunLog, RunSetup, read_checkpoint};
use trundle::io::keep_aside;

/// `trundle run`.
pub fn run(args: &RunArgs) -> Result<Outcome, AppError> {
    if args.mission.check {
        return check::check(args);
    }
    let mut robot = args.options.robot.robot()?;
    let resumed = args.mission.resume.as_deref().map(read_checkpoint).transpose()?;
    let mission = match &resumed {
        Some((checkpoint, _)) => checkpoint.mission.left.clone(),
        None => args.mission.request().mission()?,
    };
    let camera = OpenCamera::open_with(&args.camera, args.gyro, &robot.mount)?;
    camera.require_live()?;
    robot.camera = camera.intrinsics(args.intrinsics, &robot.camera)?;
    let mut setup = args.options.setup(RUN_COMMAND, &args.base.to_string(), mission, robot)?;
    setup.is_operated = args.live.is_operated();
    #[cfg(feature = "ros2")]
    if args.ros_robot.ros2 {
        setup.is_operated = true;
    }
    if let Some((_, bytes)) = &resumed {
        setup = setup.resumed_from(bytes);
    }
    setup = args.live.with_zones(setup)?;
    drive(args, &setup, camera)
}

/// Runs the robot and writes the folder.
fn drive(args: &RunArgs, setup: &RunSetup, camera: OpenCamera) -> Result<Outcome, AppError> {
    let folder = logging::output_folder(&args.out)?;
    if !args.options.common.quiet {
        let info = camera.info();
        let devices = format!("Base {}, camera {} ({})", args.base, args.camera, info.name);
        console::print(&setup.announcement(&devices, info.color.rate_hz));
    }
    let checkpoint = args.options.checkpoint.as_deref();
    let (line, progress) = console::progress(args.options.common.quiet);
    let origin = Instant::now();
    #[cfg(feature = "ros2")]
    let (node, link, observer) = args.ros_robot.start(&setup.robot, origin)?;
    #[cfg(not(feature = "ros2"))]
    let (link, observer) = (None, None);
    let (page, front_end) = args.live.front_ends(setup, progress, link, true)?;
    let start = |events, _place| {
        let body = start_hardware(&args.base, camera, setup.robot.camera, events, origin, observer)?;
        // A refused run does not change the checkpoint.
        if resumes_from_another_file(args) {
            checkpoint.map_or(Ok(()), keep_aside)?;
        }
        Ok(body)
    };
    // A robot that waits for goals may do so for days.
    let log = if setup.mission.tasks().is_empty() { RunLog::brief() } else { RunLog::default() };
    let run = run_in_real_time(setup, start, &folder, checkpoint, log, front_end);
    line.finish_and_clear();
    drop(page);
    #[cfg(feature = "ros2")]
    drop(node);
    let (run, timing) = run?;
    run_output::write(setup, run, Some(&timing), folder, args.options.common.quiet)
}

/// Whether the written checkpoint differs from the one that the run resumes from.
fn resumes_from_another_file(args: &RunArgs) -> bool {
    args.mission.resume.as_deref() != args.options.checkpoint.as_deref()
}
