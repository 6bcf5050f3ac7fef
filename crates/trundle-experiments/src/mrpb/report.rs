//! The report of the MRPB experiment: one row a run, with the benchmark's metrics and pictures.

use super::{ALIGNED, CYCLE_MS, MrpbTrial, NEAR, metrics};
use trundle_core::{Pose2, Vector2};
use trundle_io::{Summary, table_csv};
use trundle_viz::{Color, Figure, LineStyle, MapPicture, PoseStyle, Report, Table, Verdict};

const HEADER: [&str; 12] = [
    "course",
    "seed",
    "what",
    "least room, cm",
    "time near, %",
    "time, s",
    "way, m",
    "path roughness, cm2",
    "speed roughness, m/s2",
    "cycle, ms",
    "goal off, cm",
    "goal off, deg",
];

fn row(trial: &MrpbTrial) -> Vec<String> {
    let m = &trial.metrics;
    vec![
        trial.course.name(),
        trial.seed.to_string(),
        told(trial),
        format!("{:.1}", m.least_room * 100.0),
        format!("{:.1}", m.time_near * 100.0),
        format!("{:.1}", m.time),
        format!("{:.2}", m.length),
        format!("{:.5}", m.path_roughness * 1e4),
        format!("{:.3}", m.speed_roughness),
        format!("{:.2}", m.cycle_ms[0]),
        format!("{:.1}", trial.distance * 100.0),
        format!("{:.2}", trial.turn.to_degrees()),
    ]
}

fn told(trial: &MrpbTrial) -> String {
    match trial.contacts {
        0 if trial.reached() => "goal reached".to_owned(),
        0 => trial.state.to_string(),
        n => format!("{n} contacts"),
    }
}

/// For the terminal.
pub(super) fn rows(trials: &[MrpbTrial]) -> Vec<Vec<String>> {
    std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(trials.iter().map(row)).collect()
}

pub(super) fn verdict(trials: &[MrpbTrial], success: bool) -> String {
    let reached = trials.iter().filter(|trial| trial.reached()).count();
    let contacts: u32 = trials.iter().map(|trial| trial.contacts).sum();
    let slowest = trials.iter().map(|trial| trial.metrics.cycle_ms[0]).fold(0.0, f64::max);
    let head = if success { "Within the limits" } else { "Missed" };
    format!(
        "{head}: {reached} of {} runs reached the goal within {NEAR} m and {ALIGNED} rad, {contacts} contacts, control cycle \
         {slowest:.2} ms on average at worst (at most {CYCLE_MS}). In trundle's own simulator, with the benchmark's map where it has one.",
        trials.len()
    )
}

/// A name for files.
pub(super) fn file_name(trial: &MrpbTrial) -> String {
    let with = if trial.course.people.is_empty() { "" } else { "-people" };
    format!("{}-{}{with}-seed-{}", trial.course.scenario, trial.course.test, trial.seed)
}

/// The map that was drawn, with the way driven.
pub(super) fn picture(trial: &MrpbTrial) -> Vec<u8> {
    let map_from_world = trial.course.start.inverse();
    let driven: Vec<Vector2> = trial.driven.iter().map(|&p| map_from_world.transform(p)).collect();
    MapPicture::over(&trial.grid)
        .axes("x, m", "y, m")
        .polyline("driven", &driven, LineStyle::solid(Color::BLUE))
        .pose("start", Pose2::IDENTITY, PoseStyle::named(Color::GREEN))
        .pose("goal", map_from_world * trial.course.goal, PoseStyle::named(Color::VERMILLION))
        .to_png()
}

pub(super) fn report(trials: &[MrpbTrial], success: bool) -> Report {
    let told_all = verdict(trials, success);
    let note = format!(
        "Safety: least room and time nearer than {} m to an obstacle. Efficiency: time and way. Smoothness: mean square of the \
         second difference of the position, and mean change of the commanded speed over time, both at 25 Hz. Computation: the \
         mean control cycle (odometry, supervision, planning, control, safety), processor time.",
        metrics::NEAR
    );
    let table = trials.iter().map(row).fold(Table::new("Metrics", HEADER).wide(), Table::row);
    let report = Report::new("MRPB 1.0: local planning")
        .subtitle(
            "Every pair of start and goal, where the benchmark has people with and without them. A round robot of 0.25 m \
             radius at up to 0.55 m/s, with the benchmark's map where it has one, on a laser of 270 deg and 720 beams that measures all at once, wheels \
             and gyro. People walk the benchmark's ways at its mean speeds, and wait while the robot is right before them.",
        )
        .verdict(if success { Verdict::Ok(told_all) } else { Verdict::Failed(told_all) })
        .section("Metrics", &note)
        .table(table)
        .section("Ways", "The map that was drawn on the way, and the way driven in truth.");
    trials.iter().fold(report, |report, trial| {
        let caption = format!("{}, {:.1} s", told(trial), trial.metrics.time);
        report.figure(Figure::png(&trial.course.name(), &picture(trial)).caption(&caption))
    })
}

pub(super) fn csv(trials: &[MrpbTrial]) -> String {
    let header = [
        "run",
        "seed",
        "people",
        "reached",
        "contacts",
        "least_room_m",
        "time_near",
        "time_s",
        "way_m",
        "path_roughness_m2",
        "speed_roughness_mps2",
        "goal_distance_m",
        "goal_turn_rad",
        "worst_estimate_m",
    ];
    let row = |(i, trial): (usize, &MrpbTrial)| {
        let m = &trial.metrics;
        [
            (i + 1) as f64,
            trial.seed as f64,
            trial.course.people.len() as f64,
            f64::from(u8::from(trial.reached())),
            f64::from(trial.contacts),
            m.least_room,
            m.time_near,
            m.time,
            m.length,
            m.path_roughness,
            m.speed_roughness,
            trial.distance,
            trial.turn,
            trial.worst_estimate,
        ]
    };
    table_csv(header, trials.iter().enumerate().map(row))
}

pub(super) fn summary(trials: &[MrpbTrial], success: bool) -> Summary {
    let cycle = |trial: &MrpbTrial| {
        let [mean, median, p99, most] = trial.metrics.cycle_ms;
        let times =
            serde_json::json!({ "mean_ms": mean, "median_ms": median, "p99_ms": p99, "most_ms": most });
        (file_name(trial), times)
    };
    let cycles: serde_json::Map<String, serde_json::Value> = trials.iter().map(cycle).collect();
    let mut summary = Summary::new("experiment mrpb");
    summary
        .set("success", success)
        .set("runs", trials.len())
        .set("reached", trials.iter().filter(|trial| trial.reached()).count())
        .set("contacts", trials.iter().map(|trial| trial.contacts).sum::<u32>())
        .set("wall_clock", cycles);
    summary
}
