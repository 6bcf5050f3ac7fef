//! The output folder of a run: map, trajectories, report, timing page, summary.

use super::timing_page::REPORT_FILE;
use super::{RunNumbers, camera_view, landmarks_in_map, state_log, timing_page, write_zones};
use crate::real_time::RealTimeReport;
use crate::setup::mission_text;
use crate::{AppError, FinishedRun, PoseSample, RunLog, RunSetup};
use std::path::PathBuf;
use trundle_core::{Footprint, Pose2};
use trundle_io::{IoError, OutputFolder, trajectory_text_from_planar, write_map};
use trundle_viz::{Card, Chart, Color, Figure, RunMap, RunReport, Table, Verdict};

/// File of the wall-clock figures.
const TIMING_FILE: &str = "timing.html";

/// The written folder of a run.
pub struct RunOutput {
    /// The figures of the run.
    pub numbers: RunNumbers,
    /// The folder.
    pub folder: PathBuf,
    /// The reason if some results could not be written.
    pub incomplete: Option<AppError>,
}

/// Writes the folder of a run. Files for which the disk has no space are left out, as is an incomplete recording.
///
/// # Errors
/// When a file cannot be written.
pub fn write_run(
    setup: &RunSetup,
    run: &mut FinishedRun,
    timing: Option<&RealTimeReport>,
    folder: OutputFolder,
) -> Result<RunOutput, AppError> {
    for name in run.recording.failed_files.drain(..) {
        _ = std::fs::remove_file(folder.staged(&name));
    }
    if let Some(error) = run.recording.error.take() {
        folder.leave_out(error);
    }
    run.recording.checkpoint_error.take().into_iter().for_each(|error| folder.leave_out(error));
    let run = &*run;
    let numbers = RunNumbers::of(setup, run);
    write_map(&folder, "map", run.robot.grid())?;
    let (zones, map) = (run.robot.annotations(), run.robot.grid().geometry());
    write_zones(&folder, zones, map, setup.robot.limits.v)?;
    folder.write("trajectory.txt", trajectory_text_from_planar(&run.log.estimated_path()).as_bytes())?;
    if !run.log.truths.is_empty() {
        folder.write("groundtruth.txt", trajectory_text_from_planar(&run.log.truths).as_bytes())?;
    }
    let report = report(setup, run, &numbers);
    folder.write("map.png", &report.map.to_png())?;
    folder.write(REPORT_FILE, report.to_html().as_bytes())?;
    folder.write(TIMING_FILE, timing_page::html(run, &numbers, timing).as_bytes())?;
    folder.write("summary.json", numbers.summary(setup, run, timing).to_json().as_bytes())?;
    let (target, committed) = (folder.target().to_owned(), folder.commit());
    match committed {
        Ok(folder) => Ok(RunOutput { numbers, folder, incomplete: None }),
        Err(error @ IoError::Incomplete { .. }) => {
            Ok(RunOutput { numbers, folder: target, incomplete: Some(error.into()) })
        }
        Err(error) => Err(error.into()),
    }
}

fn report(setup: &RunSetup, run: &FinishedRun, numbers: &RunNumbers) -> RunReport {
    let robot = &run.robot;
    let image = run.view.image();
    let verdict = numbers.verdict();
    let plan = robot.plan();
    let curve = plan.map(|plan| plan.trajectory.points().iter().map(|p| p.pose.position()).collect());
    let pose = robot.estimate().pose;
    RunReport {
        title: title(setup),
        subtitle: subtitle(setup),
        links: vec![("Durations of the stages".to_owned(), TIMING_FILE.to_owned())],
        verdict: Some(if numbers.is_success() { Verdict::Ok(verdict) } else { Verdict::Failed(verdict) }),
        cards: cards(numbers),
        map: RunMap {
            grid: Some(robot.grid().clone()),
            landmarks: landmarks_in_map(robot),
            way_points: plan.map(|plan| plan.waypoints.points().to_vec()).unwrap_or_default(),
            curve: curve.unwrap_or_default(),
            estimated_path: run.log.estimates.iter().map(|estimate| estimate.pose).collect(),
            true_path: run.log.truths.iter().map(|(_, pose)| *pose).collect(),
            start: Some(Pose2::IDENTITY),
            goal: setup.last_goal(),
            footprint: Footprint::disc(setup.robot.footprint_radius).ok(),
            scan: robot.scan().map(|scan| (pose, scan.clone())),
        },
        camera: image.as_ref().map(|image| camera_view(image, &run.view.features)),
        depth: image.as_ref().map(|image| image.depth().clone()),
        charts: run
            .log
            .truths
            .first()
            .map(|_| error_chart(run))
            .into_iter()
            .chain([speed_chart(run)])
            .collect(),
        figures: Vec::new(),
        tables: vec![table(run, numbers)],
        states: states(&run.log),
    }
}

fn states(log: &RunLog) -> Option<Table> {
    let when = if log.is_brief() { " in the last minute" } else { "" };
    let table = || state_log(&format!("Changes of state{when}: {}", log.changes.len()), &log.changes);
    (!log.changes.is_empty()).then(table)
}

fn title(setup: &RunSetup) -> String {
    if setup.is_on_hardware() {
        format!("trundle on the base {}", setup.scene)
    } else {
        format!("trundle in the room '{}'", setup.scene)
    }
}

fn subtitle(setup: &RunSetup) -> String {
    let robot = if setup.is_on_hardware() {
        "The robot".to_owned()
    } else {
        format!("Seed {}. A simulated robot", setup.seed)
    };
    let map = if setup.checkpoint.is_some() { "with the maps of a checkpoint" } else { "with an empty map" };
    let mission = mission_text(&setup.mission);
    let mission = if mission.is_empty() { "the missions of its operator".to_owned() } else { mission };
    format!("{robot} started {map} and did its mission ({mission}) on its camera, wheels and gyro alone.")
}

fn cards(numbers: &RunNumbers) -> Vec<Card> {
    let mut cards = Vec::new();
    if let Some(error) = numbers.goal_error {
        let (cm, deg) = (error.distance * 100.0, error.dtheta.abs().to_degrees());
        cards.push(Card::new("from the goal", &format!("{cm:.1}")).unit("cm").good(numbers.is_near()));
        cards.push(Card::new("off its heading", &format!("{deg:.2}")).unit("deg").good(numbers.is_aligned()));
    }
    let contacts = numbers.contacts.to_string();
    cards.push(Card::new("contacts", &contacts).good(numbers.contacts == 0));
    cards.push(Card::new("driven", &format!("{:.1}", numbers.path_length)).unit("m"));
    cards.push(Card::new("time", &format!("{:.1}", numbers.duration)).unit("s"));
    cards
}

fn table(run: &FinishedRun, numbers: &RunNumbers) -> Table {
    let empty = Table::new("The run", ["what", "value"]);
    numbers.run_rows().into_iter().chain(run.log.body.rows()).fold(empty, Table::row)
}

/// Position error of the estimate against truth, over time.
fn error_chart(run: &FinishedRun) -> Figure {
    let samples = run.log.pose_samples();
    let line = |value: fn(&PoseSample) -> f64| samples.iter().map(|s| (s.at_s, value(s) * 100.0)).collect();
    let chart = Chart::new("How well the robot knew its place", "time, s", "error, cm");
    let chart = chart.line("position error", Color::BLUE, line(PoseSample::distance));
    Figure::chart(&chart.line("claimed bound, 95 %", Color::GREEN, line(|sample| sample.bound.distance)))
}

fn speed_chart(run: &FinishedRun) -> Figure {
    let start = run.log.start.unwrap_or_default();
    let series = |value: fn(&trundle_core::Twist2) -> f64| {
        run.log.twists.iter().map(|(stamp, twist)| (*stamp - start, value(twist))).collect::<Vec<_>>()
    };
    let chart = Chart::new("What the wheels were asked for", "time, s", "m/s, rad/s")
        .line("speed", Color::BLUE, series(|twist| twist.v))
        .line("turn rate", Color::VERMILLION, series(|twist| twist.omega));
    Figure::chart(&chart)
}
