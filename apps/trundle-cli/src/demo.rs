//! `trundle demo`: a mission in a simulated scene, in simulated or in real time.

mod args;

pub use args::DemoArgs;
use args::DemoMissionArgs;

use crate::outcome::Outcome;
use crate::{console, logging, run_output};
use trundle::app::real_time::run_in_real_time;
use trundle::app::report::mission_text;
use trundle::app::vocabulary_file::read_vocabulary;
use trundle::app::{AppError, MissionRequest, RunLog, RunRecorder, RunSetup, read_checkpoint, run_on_body};
use trundle::core::Pose2;
use trundle::experiments::simulated::{
    SimulatedRealTimeBody, load_scene, read_faults, require_free, simulated_body, simulated_real_time_body,
    time_limit,
};
use trundle::io::keep_aside;
use trundle::runtime::Mission;
use trundle::sim::{Scene, Simulator};

/// `trundle demo`.
pub fn run(args: &DemoArgs) -> Result<Outcome, AppError> {
    let robot = args.robot.robot()?;
    let mut scene = load_scene(&args.scene, args.place.options())?;
    let faults = args.faults.as_deref().map(read_faults).transpose()?.unwrap_or_default();
    let resumed = args.state.resume.and(args.state.checkpoint.as_deref()).map(read_checkpoint).transpose()?;
    let mission = match &resumed {
        Some((checkpoint, _)) => checkpoint.mission.left.clone(),
        None => mission(&args.mission, &scene)?,
    };
    let mut setup = RunSetup::new(&scene.name, mission, robot.with_seed(args.place.seed));
    setup.seed = args.place.seed;
    setup.map_from_world = scene.start.inverse();
    setup.is_operated = args.live.is_operated();
    let limit = if setup.is_operated { f64::MAX } else { time_limit(&setup.mission) };
    setup.time_limit = args.time_limit.unwrap_or(limit);
    setup.real_time = args.real_time || setup.is_operated;
    setup.recording = args.record;
    if let Some(file) = &args.vocabulary {
        setup = setup.with_vocabulary(&read_vocabulary(file)?);
    }
    if let Some((_, bytes)) = &resumed {
        setup = setup.resumed_from(bytes);
    }
    setup = args.live.with_zones(setup)?;
    require_free("start", &scene, scene.start, &setup.robot)?;
    for goal in setup.mission.tasks().iter().filter_map(RunSetup::goal_of) {
        require_free("goal", &scene, scene.start * goal, &setup.robot)?;
    }
    scene.start = args.state.resume.map_or(scene.start, |pose| pose.0);
    let body = if setup.real_time { simulated_real_time_body } else { simulated_body };
    let body =
        Simulator::new(scene, body(&setup.robot, faults)?, args.place.seed).map_err(AppError::input)?;
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
    let (page, front_end) = args.live.front_ends(setup, progress, None, true)?;
    if setup.real_time {
        let start = |events, place| SimulatedRealTimeBody::start(body, events, place);
        let run = run_in_real_time(setup, start, &folder, checkpoint, RunLog::default(), front_end);
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

/// The requested goals, or the scene's. Unless the drive is direct, exploration precedes the goals and the return follows.
fn mission(args: &DemoMissionArgs, scene: &Scene) -> Result<Mission, AppError> {
    let mut goals: Vec<Pose2> = args.goal.iter().map(|goal| goal.0).collect();
    if goals.is_empty() && !(args.direct && args.dock) {
        goals.push(scene.start_from_goal());
    }
    MissionRequest { goals, explore: !args.direct, dock: args.dock, file: None }.mission()
}
