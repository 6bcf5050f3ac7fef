//! The report of the MRPB experiment: one row per run, with the benchmark's metrics and pictures.

use super::metrics::NEAR_OBSTACLE_M;
use super::trial::{GOAL_TOLERANCE_M, GOAL_TOLERANCE_RAD, MAX_MEAN_CYCLE_MS, MrpbTrial};
use trundle_core::{Pose2, Vector2};
use trundle_io::{Summary, table_csv};
use trundle_viz::{Color, Figure, LineStyle, MapPicture, PoseStyle, Report, Table, Verdict};

const HEADER: [&str; 12] = [
    "course",
    "seed",
    "what",
    "minimum clearance, cm",
    "time near, %",
    "time, s",
    "path, m",
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
        outcome_text(trial),
        format!("{:.1}", m.min_clearance * 100.0),
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

fn outcome_text(trial: &MrpbTrial) -> String {
    match trial.contacts {
        0 if trial.reached() => "goal reached".to_owned(),
        0 => trial.state.to_string(),
        n => format!("{n} contacts"),
    }
}

/// The rows for the terminal.
pub(super) fn rows(trials: &[MrpbTrial]) -> Vec<Vec<String>> {
    std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(trials.iter().map(row)).collect()
}

pub(super) fn verdict(trials: &[MrpbTrial], success: bool) -> String {
    let reached = trials.iter().filter(|trial| trial.reached()).count();
    let contacts: u32 = trials.iter().map(|trial| trial.contacts).sum();
    let slowest = trials.iter().map(|trial| trial.metrics.cycle_ms[0]).fold(0.0, f64::max);
    let head = if success { "Within the limits" } else { "Missed" };
    format!(
        "{head}: {reached} of {} runs reached the goal within {GOAL_TOLERANCE_M} m and {GOAL_TOLERANCE_RAD} rad, {contacts} contacts, control cycle \
         {slowest:.2} ms on average at worst (at most {MAX_MEAN_CYCLE_MS}). In trundle's own simulator, with the benchmark's map where it has one.",
        trials.len()
    )
}

/// A name for files.
pub(super) fn file_name(trial: &MrpbTrial) -> String {
    let with = if trial.course.people.is_empty() { "" } else { "-people" };
    format!("{}-{}{with}-seed-{}", trial.course.scenario, trial.course.test, trial.seed)
}

/// The robot's map, with the path driven.
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
    let sentence = verdict(trials, success);
    let note = format!(
        "Safety: minimum clearance and time nearer than {} m to an obstacle. Efficiency: time and path length. Smoothness: mean square of the \
         second difference of the position, and mean change of the commanded speed over time, both at 25 Hz. Computation: the \
         mean control cycle (odometry, supervision, planning, control, safety), processor time.",
        NEAR_OBSTACLE_M
    );
    let table = trials.iter().map(row).fold(Table::new("Metrics", HEADER).wide(), Table::row);
    let report = Report::new("MRPB 1.0: local planning")
        .subtitle(
            "Every pair of start and goal, where the benchmark has people with and without them. A round robot of 0.25 m \
             radius at up to 0.55 m/s, with the benchmark's map where it has one, on a laser of 270 deg and 720 beams that measures all at once, wheels \
             and gyro. People walk the benchmark's paths at its mean speeds, and wait while the robot is right before them.",
        )
        .verdict(if success { Verdict::Ok(sentence) } else { Verdict::Failed(sentence) })
        .section("Metrics", &note)
        .table(table)
        .section("Paths", "The robot's map, and the path driven in truth.");
    trials.iter().fold(report, |report, trial| {
        let caption = format!("{}, {:.1} s", outcome_text(trial), trial.metrics.time);
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
        "min_clearance_m",
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
            m.min_clearance,
            m.time_near,
            m.time,
            m.length,
            m.path_roughness,
            m.speed_roughness,
            trial.distance,
            trial.turn,
            trial.max_estimate_error,
        ]
    };
    table_csv(header, trials.iter().enumerate().map(row))
}

pub(super) fn summary(trials: &[MrpbTrial], success: bool) -> Summary {
    let cycle = |trial: &MrpbTrial| {
        let [mean, median, p99, max] = trial.metrics.cycle_ms;
        let times = serde_json::json!({ "mean_ms": mean, "median_ms": median, "p99_ms": p99, "max_ms": max });
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

#[cfg(test)]
mod tests {
    use super::super::course::Course;
    use super::super::metrics::Metrics;
    use super::*;
    use trundle_core::OccupancyGrid;
    use trundle_runtime::DriveState;

    fn trial(distance: f64, contacts: u32, cycle_ms: f64) -> MrpbTrial {
        let metrics = Metrics {
            min_clearance: 0.3,
            time_near: 0.0,
            time: 20.0,
            length: 8.0,
            path_roughness: 1e-4,
            speed_roughness: 0.1,
            cycle_ms: [cycle_ms; 4],
        };
        MrpbTrial {
            course: Course::between("empty", Pose2::IDENTITY, Pose2::new(3.0, 0.0, 0.0)),
            seed: 2,
            metrics,
            contacts,
            distance,
            turn: 0.01,
            max_estimate_error: 0.02,
            state: DriveState::Arrived,
            driven: vec![Vector2::zeros(), Vector2::new(3.0, 0.0)],
            grid: OccupancyGrid::from_ascii(0.5, "..\n..").unwrap(),
        }
    }

    #[test]
    fn a_run_succeeds_at_the_goal_untouched_and_in_time() {
        assert!(trial(0.1, 0, 0.5).success());
        assert!(!trial(0.3, 0, 0.5).success(), "beyond the tolerance");
        assert!(!trial(0.1, 1, 0.5).success(), "a contact");
        assert!(!trial(0.1, 0, 2.5).success(), "a slow cycle");
    }

    #[test]
    fn the_verdict_counts_goals_contacts_and_the_slowest_cycle() {
        let text = verdict(&[trial(0.1, 0, 0.5), trial(0.5, 2, 1.5)], false);
        assert!(text.starts_with("Missed: 1 of 2 runs reached the goal"), "{text}");
        assert!(text.contains("2 contacts") && text.contains("1.50 ms"), "{text}");
        assert!(verdict(&[trial(0.1, 0, 0.5)], true).starts_with("Within the limits"));
    }

    #[test]
    fn table_and_csv_have_a_row_for_each_run() {
        let trials = [trial(0.1, 0, 0.5), trial(0.5, 2, 1.5)];
        let table = rows(&trials);
        assert!(table.len() == 3 && table.iter().all(|row| row.len() == HEADER.len()));
        assert_eq!([table[1][2].as_str(), table[2][2].as_str()], ["goal reached", "2 contacts"]);
        let text = csv(&trials);
        let columns = text.lines().next().unwrap().split(',').count();
        assert!(text.lines().count() == 3 && text.lines().all(|line| line.split(',').count() == columns));
    }
}
