//! `trundle demo`: a mission in a simulated scene, in simulated or in real time.

mod args;

use args::DemoMissionArgs;
pub use args::{DemoArgs, RecordArg};

use crate::common_args::PoseArg;
use crate::outcome::Outcome;
use crate::{console, logging, run_output};
use trundle::app::real_time::run_in_real_time;
use trundle::app::report::mission_text;
use trundle::app::vocabulary_file::read_vocabulary;
use trundle::app::{AppError, RunLog, RunRecorder, RunSetup, read_checkpoint, run_on_body};
use trundle::core::Invalid;
use trundle::experiments::simulated::{
    SceneOptions, SimulatedRealTimeBody, load_scene, read_faults, require_free, simulated_body,
    simulated_real_time_body, time_limit,
};
use trundle::io::keep_aside;
use trundle::runtime::{Mission, Task};
use trundle::sim::{Scene, Simulator};

/// `trundle demo`.
pub fn run(args: &DemoArgs) -> Result<Outcome, AppError> {
    let pose = |arg: Option<PoseArg>| arg.map(|pose| pose.0);
    let (start, station) = (pose(args.start), pose(args.station));
    let options = SceneOptions { seed: args.seed, mesh: args.mesh.options(), start, station };
    let robot = args.robot.robot()?;
    let mut scene = load_scene(&args.scene, options)?;
    let faults = args.faults.as_deref().map(read_faults).transpose()?.unwrap_or_default();
    let resumed = args.state.resume.and(args.state.checkpoint.as_deref()).map(read_checkpoint).transpose()?;
    let mission = match &resumed {
        Some((checkpoint, _)) => checkpoint.mission.left.clone(),
        None => mission(&args.mission, &scene)?,
    };
    let mut setup = RunSetup::new(&scene.name, mission, robot.with_seed(args.seed));
    setup.seed = args.seed;
    setup.map_from_world = scene.start.inverse();
    setup.time_limit = args.time_limit.unwrap_or_else(|| time_limit(&setup.mission));
    setup.real_time = args.real_time;
    setup.recording = args.record.content();
    if let Some(file) = &args.vocabulary {
        setup = setup.with_vocabulary(&read_vocabulary(file)?);
    }
    if let Some((_, bytes)) = &resumed {
        setup = setup.resumed_from(bytes);
    }
    require_free("start", &scene, scene.start, &setup.robot)?;
    for goal in setup.mission.tasks().iter().filter_map(RunSetup::goal_of) {
        require_free("goal", &scene, scene.start * goal, &setup.robot)?;
    }
    scene.start = args.state.resume.map_or(scene.start, |pose| pose.0);
    let body = if args.real_time { simulated_real_time_body } else { simulated_body };
    let body = Simulator::new(scene, body(&setup.robot, faults)?, args.seed).map_err(AppError::input)?;
    drive(args, &setup, body)
}

/// Runs the robot in its simulated body and writes the folder.
fn drive(args: &DemoArgs, setup: &RunSetup, mut body: Simulator) -> Result<Outcome, AppError> {
    let folder = logging::output_folder(&args.out)?;
    if !args.common.quiet {
        let (scene, seed, mission) = (&setup.scene, setup.seed, mission_text(&setup.mission));
        console::print(&format!("Room '{scene}', seed {seed}, on camera, wheels and gyro alone: {mission}."));
        console::print(&setup.recording.announcement(
            &setup.robot.camera,
            body.config().camera_rate_hz,
            setup.time_limit,
        ));
    }
    let (line, progress) = console::progress(args.common.quiet);
    let checkpoint = args.state.checkpoint.as_deref();
    if args.state.resume.is_none() {
        checkpoint.map_or(Ok(()), keep_aside)?;
    }
    if args.real_time {
        let start = |events, place| SimulatedRealTimeBody::start(body, events, place);
        let run = run_in_real_time(setup, start, &folder, checkpoint, RunLog::default(), progress);
        line.finish_and_clear();
        let (run, timing) = run?;
        return run_output::write(setup, run, Some(&timing), folder, args.common.quiet);
    }
    let recorder = RunRecorder::of_content(setup.recording, &folder)?.with_checkpoint_file(checkpoint)?;
    let run = run_on_body(setup, &mut body, recorder, RunLog::default(), progress);
    line.finish_and_clear();
    run_output::write(setup, run?, None, folder, args.common.quiet)
}

/// The goals asked for, or the scene's own; before them exploration and after them the return, unless the drive is direct.
fn mission(args: &DemoMissionArgs, scene: &Scene) -> Result<Mission, Invalid> {
    let mut goals: Vec<Task> = args.goal.iter().map(|goal| Task::Go(goal.0)).collect();
    let dock = if args.dock { vec![Task::Dock] } else { vec![] };
    if goals.is_empty() && !(args.direct && args.dock) {
        goals.push(Task::Go(scene.start_from_goal()));
    }
    if args.direct {
        return Mission::new([goals, dock].concat());
    }
    // The station is the better place to end at than the start.
    let end = if args.dock { dock } else { vec![Task::Return] };
    Mission::new([vec![Task::Explore], goals, end].concat())
}
