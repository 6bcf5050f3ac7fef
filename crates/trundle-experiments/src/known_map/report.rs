//! The report of the runs on given maps.

use super::trial::{ESTIMATE_TOLERANCE_M, GOAL_TOLERANCE_M, KnownMapTrial};
use trundle_core::Pose2;
use trundle_io::{Summary, table_csv};
use trundle_viz::{Color, Figure, LineStyle, MapPicture, PoseStyle, Report, Table, Verdict};

const HEADER: [&str; 8] = [
    "place",
    "seed",
    "what",
    "goal off, cm",
    "goal off, deg",
    "estimate off at most, cm",
    "path, m",
    "time, s",
];

fn row(trial: &KnownMapTrial) -> Vec<String> {
    let what =
        if trial.contacts > 0 { format!("{} contacts", trial.contacts) } else { trial.state.to_string() };
    vec![
        trial.place.clone(),
        trial.seed.to_string(),
        what,
        format!("{:.1}", trial.distance * 100.0),
        format!("{:.2}", trial.turn.to_degrees()),
        format!("{:.1}", trial.max_estimate_error * 100.0),
        format!("{:.2}", trial.length),
        format!("{:.1}", trial.time),
    ]
}

/// The rows for the terminal.
pub(super) fn rows(trials: &[KnownMapTrial]) -> Vec<Vec<String>> {
    std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(trials.iter().map(row)).collect()
}

/// Counted quantities of all runs.
struct Counts {
    arrived: usize,
    false_arrivals: usize,
    wrong_estimates: usize,
    contacts: u32,
    largest_error: f64,
}

impl Counts {
    fn of(trials: &[KnownMapTrial]) -> Self {
        let count = |is: fn(&KnownMapTrial) -> bool| trials.iter().filter(|trial| is(trial)).count();
        Self {
            arrived: count(KnownMapTrial::has_arrived),
            false_arrivals: count(KnownMapTrial::is_false_arrival),
            wrong_estimates: count(KnownMapTrial::is_estimate_wrong),
            contacts: trials.iter().map(|trial| trial.contacts).sum(),
            largest_error: trials.iter().map(|trial| trial.max_estimate_error).fold(0.0, f64::max),
        }
    }
}

pub(super) fn verdict(trials: &[KnownMapTrial], success: bool) -> String {
    let c = Counts::of(trials);
    let head = if success { "Within the limits" } else { "Missed" };
    format!(
        "{head}: {} of {} runs arrived, {} of them more than {GOAL_TOLERANCE_M} m from the goal; the estimate was off by more than \
         {ESTIMATE_TOLERANCE_M} m and three of its standard deviations in {} runs (off by {:.3} m at most); {} contacts.",
        c.arrived,
        trials.len(),
        c.false_arrivals,
        c.wrong_estimates,
        c.largest_error,
        c.contacts
    )
}

/// The robot's map, and the path driven in truth.
pub(super) fn picture(trial: &KnownMapTrial) -> Vec<u8> {
    MapPicture::over(&trial.grid)
        .axes("x, m", "y, m")
        .polyline("driven", &trial.driven, LineStyle::solid(Color::BLUE))
        .pose("start", Pose2::IDENTITY, PoseStyle::named(Color::GREEN))
        .pose("goal", trial.goal, PoseStyle::named(Color::VERMILLION))
        .to_png()
}

pub(super) fn report(trials: &[KnownMapTrial], success: bool) -> Report {
    let sentence = verdict(trials, success);
    let table = trials.iter().map(row).fold(Table::new("Runs", HEADER).wide(), Table::row);
    let report = Report::new("A robot on a given map")
        .subtitle(
            "Halls of 20 to 60 m with few doors, mazes, and rooms a part of whose furniture was moved after the map was made. The robot of MRPB \
             1.0 with its map, its start pose, wheels, gyro and a laser of 270 deg.",
        )
        .verdict(if success { Verdict::Ok(sentence) } else { Verdict::Failed(sentence) })
        .table(table)
        .section("Wrong runs", "The robot's map at the end, and the path driven in truth.");
    trials.iter().filter(|trial| !trial.is_right()).fold(report, |report, trial| {
        let caption = format!("{}, seed {}: {}", trial.place, trial.seed, trial.state);
        report.figure(Figure::png(&trial.file_name(), &picture(trial)).caption(&caption))
    })
}

pub(super) fn csv(trials: &[KnownMapTrial]) -> String {
    let header = [
        "run",
        "seed",
        "arrived",
        "contacts",
        "goal_distance_m",
        "goal_turn_rad",
        "worst_estimate_m",
        "worst_unnoticed_m",
        "length_m",
        "time_s",
    ];
    let row = |(i, trial): (usize, &KnownMapTrial)| {
        [
            (i + 1) as f64,
            trial.seed as f64,
            f64::from(u8::from(trial.has_arrived())),
            f64::from(trial.contacts),
            trial.distance,
            trial.turn,
            trial.max_estimate_error,
            trial.max_unnoticed_error,
            trial.length,
            trial.time,
        ]
    };
    table_csv(header, trials.iter().enumerate().map(row))
}

pub(super) fn summary(trials: &[KnownMapTrial], success: bool) -> Summary {
    let c = Counts::of(trials);
    let mut summary = Summary::new("experiment known-map");
    summary
        .set("success", success)
        .set("runs", trials.len())
        .set("arrived", c.arrived)
        .set("false_arrivals", c.false_arrivals)
        .set("wrong_estimates", c.wrong_estimates)
        .set("largest_estimate_error_m", c.largest_error)
        .set("contacts", c.contacts);
    summary
}
