//! `trundle demo`: a mission in a simulated scene, in simulated or in real time.

mod args;

pub use args::DemoArgs;

use crate::outcome::Outcome;
use crate::{console, logging, run_output};
use std::path::Path;
use trundle::app::real_time::run_in_real_time;
use trundle::app::{AppError, RunLog, RunRecorder, RunSetup, run_on_body};
use trundle::experiments::simulated::{DemoRequest, SimulatedRealTimeBody};
use trundle::io::keep_aside;
use trundle::sim::Simulator;

/// `trundle demo`.
pub fn run(args: &DemoArgs) -> Result<Outcome, AppError> {
    let request = DemoRequest {
        scene: args.scene.clone(),
        place: args.place.options(),
        goals: args.mission.goal.iter().map(|goal| goal.0).collect(),
        is_direct: args.mission.direct,
        dock: args.mission.dock,
        is_operated: args.live.is_operated(),
        real_time: args.real_time,
        checkpoint: args.state.checkpoint.as_deref().map(Path::to_owned),
        resume: args.state.resume.map(|pose| pose.0),
        record: args.record,
        vocabulary: args.vocabulary.clone(),
        faults: args.faults.clone(),
        time_limit: args.time_limit,
        robot: args.robot.robot()?,
    };
    let (setup, body) = request.prepare(|setup| args.live.with_zones(setup))?;
    drive(args, &setup, body)
}

/// Runs the robot in its simulated body and writes the folder.
fn drive(args: &DemoArgs, setup: &RunSetup, mut body: Simulator) -> Result<Outcome, AppError> {
    let folder = logging::output_folder(&args.out)?;
    if !args.common.quiet {
        let room = format!("Room '{}', seed {}, on camera, wheels and gyro alone", setup.scene, setup.seed);
        console::print(&setup.announcement(&room, body.config().camera_rate_hz));
    }
    let (line, progress) = console::progress(args.common.quiet);
    let checkpoint = args.state.checkpoint.as_deref();
    if args.state.resume.is_none() {
        checkpoint.map_or(Ok(()), keep_aside)?;
    }
    let (page, front_end) = args.live.front_ends(setup, progress, None, true)?;
    if setup.real_time {
        let start = |events, place| SimulatedRealTimeBody::start(body, events, place);
        let run = run_in_real_time(setup, start, &folder, checkpoint, setup.log(), front_end);
        line.finish_and_clear();
        drop(page);
        let (run, timing) = run?;
        return run_output::write(setup, run, Some(&timing), folder, args.common.quiet);
    }
    let recorder = RunRecorder::of_content(setup.recording, &folder)?.with_checkpoint_file(checkpoint)?;
    let run = run_on_body(setup, &mut body, recorder, RunLog::default(), front_end);
    line.finish_and_clear();
    run_output::write(setup, run?, None, folder, args.common.quiet)
}
