//! The report of the BARN experiment: table, scores, pictures of single worlds.

use super::trial::BarnTrial;
use super::worlds::BarnWorld;
use trundle_core::{Pose2, Vector2};
use trundle_io::{Summary, table_csv};
use trundle_viz::{
    BarChart, Color, DotStyle, Figure, LineStyle, MapPicture, PoseStyle, Report, Table, Verdict,
};

/// Smallest fraction of runs at the goal without a contact; below it the experiment fails. Source: ours.
const MIN_SUCCESS_SHARE: f64 = 0.97;
/// Mean score of the runs; below it the experiment fails. Source: ours.
const MIN_MEAN_SCORE: f64 = 0.45;

/// BarnMeans over all runs.
pub(super) struct BarnMeans {
    runs: usize,
    worlds: usize,
    success: f64,
    score: f64,
    time: f64,
    contacts: usize,
    cycle_ms: (f64, f64),
}

impl BarnMeans {
    pub(super) fn of(trials: &[BarnTrial]) -> Self {
        let n = trials.len().max(1) as f64;
        let good: Vec<&BarnTrial> = trials.iter().filter(|trial| trial.success).collect();
        let mut worlds: Vec<usize> = trials.iter().map(|trial| trial.world.id).collect();
        worlds.dedup();
        let mut medians: Vec<f64> = trials.iter().map(|trial| trial.cycle_ms.0).collect();
        medians.sort_by(f64::total_cmp);
        Self {
            runs: trials.len(),
            worlds: worlds.len(),
            success: good.len() as f64 / n,
            score: trials.iter().map(|trial| trial.score).sum::<f64>() / n,
            time: good.iter().map(|trial| trial.time).sum::<f64>() / good.len().max(1) as f64,
            contacts: trials.iter().filter(|trial| trial.contacts > 0).count(),
            cycle_ms: (
                medians.get(medians.len() / 2).copied().unwrap_or(0.0),
                trials.iter().map(|trial| trial.cycle_ms.1).fold(0.0, f64::max),
            ),
        }
    }

    pub(super) fn within(&self) -> bool {
        self.success >= MIN_SUCCESS_SHARE && self.score >= MIN_MEAN_SCORE
    }

    pub(super) fn verdict(&self) -> String {
        let head = if self.within() { "Within the limits" } else { "Missed" };
        format!(
            "{head}: {:.1} % of {} runs in {} worlds reached the goal (at least {:.0}), mean score {:.4} (at least {MIN_MEAN_SCORE}), \
             {:.1} s on average, {} runs with a contact. In trundle's own simulator, with a laser that measures all beams at \
             once; stock DWA reaches 88 % in the challenge's.",
            self.success * 100.0,
            self.runs,
            self.worlds,
            MIN_SUCCESS_SHARE * 100.0,
            self.score,
            self.time,
            self.contacts
        )
    }
}

/// Maximum number of worlds in the table. Source: ours.
const MAX_TABLE_WORLDS: usize = 15;

/// The trials with the worst first, then by time over optimal time.
fn worst_first(trials: &[BarnTrial]) -> Vec<&BarnTrial> {
    let mut sorted: Vec<&BarnTrial> = trials.iter().collect();
    let slowness = |trial: &BarnTrial| trial.time / trial.world.optimal_time;
    sorted.sort_by(|a, b| a.success.cmp(&b.success).then(slowness(b).total_cmp(&slowness(a))));
    sorted
}

const HEADER: [&str; 9] = [
    "world",
    "seed",
    "what",
    "time, s",
    "optimal, s",
    "score",
    "path, m",
    "minimum clearance, cm",
    "estimate off, cm",
];

fn row(trial: &BarnTrial) -> Vec<String> {
    vec![
        trial.world.id.to_string(),
        trial.seed.to_string(),
        trial.outcome_text(),
        format!("{:.1}", trial.time),
        format!("{:.1}", trial.world.optimal_time),
        format!("{:.3}", trial.score),
        format!("{:.1}", trial.length),
        format!("{:.1}", trial.min_clearance * 100.0),
        format!("{:.1}", trial.max_estimate_error * 100.0),
    ]
}

/// The worst worlds and the mean, for the terminal.
pub(super) fn rows(trials: &[BarnTrial], means: &BarnMeans) -> Vec<Vec<String>> {
    let mut rows = vec![HEADER.map(str::to_owned).to_vec()];
    rows.extend(worst_first(trials).into_iter().take(MAX_TABLE_WORLDS).map(row));
    let mean = ["mean", "", &format!("{:.1} % reached", means.success * 100.0)].map(str::to_owned);
    let numbers = [format!("{:.1}", means.time), String::new(), format!("{:.4}", means.score)];
    rows.push(mean.into_iter().chain(numbers).chain(vec![String::new(); 3]).collect());
    rows
}

/// The worst worlds and typical ones.
fn shown(trials: &[BarnTrial]) -> Vec<(String, &BarnTrial)> {
    let sorted = worst_first(trials);
    let worst = sorted.iter().take(6).enumerate().map(|(i, t)| (format!("worst-{}", i + 1), *t));
    let middle = [sorted.len() / 2, sorted.len() * 3 / 4];
    let typical = middle.iter().enumerate().filter_map(|(i, at)| {
        let place = if i == 0 { "median" } else { "good" };
        Some((place.to_owned(), *sorted.get(*at)?))
    });
    worst.chain(typical).collect()
}

pub(super) fn pictures(trials: &[BarnTrial]) -> Vec<(String, Vec<u8>)> {
    shown(trials).into_iter().map(|(name, trial)| (format!("{name}.png"), picture(trial))).collect()
}

/// The true obstacles over the robot's map, with the driven path.
fn picture(trial: &BarnTrial) -> Vec<u8> {
    let start = BarnWorld::start();
    let map_from_world = start.inverse();
    let moved = |points: &[Vector2]| points.iter().map(|&p| map_from_world.transform(p)).collect::<Vec<_>>();
    let goal = map_from_world * BarnWorld::goal();
    MapPicture::over(&trial.grid)
        .axes("x, m", "y, m")
        .dots("cylinders", &moved(&trial.world.cylinders), DotStyle::crowd(Color::VERMILLION))
        .polyline("driven", &moved(&trial.driven), LineStyle::solid(Color::BLUE))
        .pose("start", Pose2::IDENTITY, PoseStyle::named(Color::GREEN))
        .pose("goal", goal, PoseStyle::named(Color::VERMILLION))
        .window(Vector2::new(4.5, 0.0), 7.5)
        .to_png()
}

/// Number of runs with a value in each bin.
fn histogram(title: &str, bins: &[(f64, f64)], values: impl Iterator<Item = f64>) -> Figure {
    let values: Vec<f64> = values.collect();
    let chart = bins.iter().fold(BarChart::new(title, "runs", "runs", ""), |chart, (low, high)| {
        let count = values.iter().filter(|value| (*low..*high).contains(*value)).count() as f64;
        chart.row(&format!("{low:.2} to {high:.2}"), count, count)
    });
    Figure::bars(&chart)
}

pub(super) fn report(trials: &[BarnTrial], means: &BarnMeans) -> Report {
    let sentence = means.verdict();
    let verdict = if means.within() { Verdict::Ok(sentence) } else { Verdict::Failed(sentence) };
    let worst = worst_first(trials).into_iter().take(MAX_TABLE_WORLDS).map(row);
    let scores =
        [(0.0, 0.01), (0.01, 0.2), (0.2, 0.3), (0.3, 0.4), (0.4, 0.45), (0.45, 0.4999), (0.4999, 1.0)];
    let ratios = [(0.0, 1.5), (1.5, 2.0), (2.0, 2.5), (2.5, 3.0), (3.0, 4.0), (4.0, 8.0), (8.0, 100.0)];
    let slowness = trials.iter().filter(|t| t.success).map(|trial| trial.time / trial.world.optimal_time);
    let mut report = Report::new("The BARN challenge")
        .subtitle(
            "250 worlds of cylinders, a robot of 0.508 x 0.430 m at up to 2 m/s from an empty map, on a laser of 270 deg and \
             720 beams, wheels and gyro; in trundle's simulator. The clock starts when the robot has gone 0.1 m.",
        )
        .verdict(verdict)
        .table(worst.fold(Table::new("The worst worlds", HEADER), Table::row))
        .section("All runs", "The score is at most 0.5, for a time of twice the optimal one or less.")
        .figure(histogram("Score", &scores, trials.iter().map(|trial| trial.score)))
        .figure(histogram("Time over optimal time, goal reached", &ratios, slowness))
        .section("Paths", "The six worst worlds, the median one and a good one.");
    for (name, trial) in shown(trials) {
        let title = format!("World {} ({name})", trial.world.id);
        let caption = format!("{}, {:.1} s, score {:.3}", trial.outcome_text(), trial.time, trial.score);
        report = report.figure(Figure::png(&title, &picture(trial)).caption(&caption));
    }
    report
}

pub(super) fn csv(trials: &[BarnTrial]) -> String {
    let header = [
        "world",
        "seed",
        "success",
        "contacts",
        "time_s",
        "optimal_time_s",
        "score",
        "way_m",
        "min_clearance_m",
        "worst_estimate_m",
        "plans",
    ];
    let row = |trial: &BarnTrial| {
        [
            trial.world.id as f64,
            trial.seed as f64,
            f64::from(u8::from(trial.success)),
            f64::from(trial.contacts),
            trial.time,
            trial.world.optimal_time,
            trial.score,
            trial.length,
            trial.min_clearance,
            trial.max_estimate_error,
            trial.plans as f64,
        ]
    };
    table_csv(header, trials.iter().map(row))
}

pub(super) fn summary(trials: &[BarnTrial], means: &BarnMeans) -> Summary {
    let mut summary = Summary::new("experiment barn");
    summary
        .set("success", means.within())
        .set("runs", trials.len())
        .set("worlds", means.worlds)
        .set("reached", means.success)
        .set("mean_score", means.score)
        .set("mean_time_s", means.time)
        .set("runs_with_contact", means.contacts)
        .set(
            "wall_clock",
            serde_json::json!({ "cycle_median_ms": means.cycle_ms.0, "cycle_most_ms": means.cycle_ms.1 }),
        );
    summary
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::OccupancyGrid;
    use trundle_runtime::DriveState;

    fn trial(id: usize, success: bool, time: f64) -> BarnTrial {
        BarnTrial {
            world: BarnWorld { id, optimal_time: 5.0, cylinders: Vec::new() },
            seed: 1,
            success,
            time,
            score: if success { 0.5 } else { 0.0 },
            contacts: u32::from(!success),
            length: 10.0,
            min_clearance: 0.2,
            max_estimate_error: 0.1,
            plans: 3,
            cycle_ms: (1.0, 2.0),
            state: DriveState::Idle,
            driven: vec![Vector2::zeros(), Vector2::new(1.0, 0.0)],
            grid: OccupancyGrid::from_ascii(0.5, "..\n..").unwrap(),
        }
    }

    /// `good` runs that reached the goal, then `bad` ones.
    fn trials(good: usize, bad: usize) -> Vec<BarnTrial> {
        (0..good + bad).map(|i| trial(i, i < good, 10.0 + i as f64)).collect()
    }

    #[test]
    fn the_limits_are_shares_of_all_runs() {
        assert!(BarnMeans::of(&trials(97, 3)).within());
        assert!(!BarnMeans::of(&trials(96, 4)).within(), "a share of 96 %");
        let slow: Vec<BarnTrial> = trials(10, 0).into_iter().map(|t| BarnTrial { score: 0.4, ..t }).collect();
        assert!(!BarnMeans::of(&slow).within(), "a mean score of 0.4");
        assert!(!BarnMeans::of(&[]).within(), "no run proves nothing");
    }

    #[test]
    fn the_verdict_agrees_with_the_limits() {
        for (good, bad) in [(10, 0), (5, 5), (0, 1)] {
            let means = BarnMeans::of(&trials(good, bad));
            let head = if means.within() { "Within the limits" } else { "Missed" };
            assert!(means.verdict().starts_with(head), "{}", means.verdict());
        }
        assert!(BarnMeans::of(&trials(1, 1)).verdict().contains("50.0 % of 2 runs in 2 worlds"));
    }

    #[test]
    fn the_table_begins_with_the_failures_and_ends_with_the_mean() {
        let trials = trials(20, 2);
        let rows = rows(&trials, &BarnMeans::of(&trials));
        assert_eq!(rows.len(), 1 + MAX_TABLE_WORLDS + 1, "header, worst worlds, mean");
        assert!(rows.iter().all(|row| row.len() == HEADER.len()));
        assert_eq!([rows[1][2].as_str(), rows[2][2].as_str()], ["contact", "contact"]);
        assert_eq!((rows[3][2].as_str(), rows[3][0].as_str()), ("goal reached", "19"), "then the slowest");
        assert_eq!(rows[rows.len() - 1][0], "mean");
    }

    #[test]
    fn the_csv_holds_every_run_in_order() {
        let text = csv(&trials(2, 1));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4);
        let columns = lines[0].split(',').count();
        assert!(lines.iter().all(|line| line.split(',').count() == columns), "{text}");
    }

    #[test]
    fn every_run_is_on_the_page_at_most_once_as_a_picture() {
        let few = trials(3, 0);
        let names: Vec<String> = shown(&few).into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["worst-1", "worst-2", "worst-3", "median", "good"]);
        assert!(report(&few, &BarnMeans::of(&few)).to_html().contains("World 2 (worst-1)"));
    }
}
