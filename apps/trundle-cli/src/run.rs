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
use trundle::app::{AppError, RUN_COMMAND, RunSetup, first_mission, keep_other_checkpoint};

/// `trundle run`.
pub fn run(args: &RunArgs) -> Result<Outcome, AppError> {
    if args.mission.check {
        return check::check(args);
    }
    let mut robot = args.options.robot.robot()?;
    let (request, resume) = (args.mission.request(), args.mission.resume.as_deref());
    let (mission, resumed) = first_mission(&request, resume, args.is_operated())?;
    let camera = OpenCamera::open_with(&args.camera, args.gyro, &robot.mount)?;
    camera.require_live()?;
    robot.camera = camera.intrinsics(args.intrinsics, &robot.camera)?;
    let mut setup = args.options.setup(RUN_COMMAND, &args.base.to_string(), mission, robot)?;
    setup.is_operated = args.is_operated();
    let setup = resumed.iter().fold(setup, |setup, bytes| setup.resumed_from(bytes));
    drive(args, &args.live.with_zones(setup)?, camera)
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
        keep_other_checkpoint(checkpoint, args.mission.resume.as_deref()).map(|()| body)
    };
    let log = setup.log();
    let run = run_in_real_time(setup, start, &folder, checkpoint, log, front_end);
    line.finish_and_clear();
    drop(page);
    #[cfg(feature = "ros2")]
    drop(node);
    let (run, timing) = run?;
    run_output::write(setup, run, Some(&timing), folder, args.options.common.quiet)
}
