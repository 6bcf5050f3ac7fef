//! The point stabilisation of \[Li18\]: eight start poses around one goal, from an empty map, without ground truth.

use crate::trial::{self, Trial, TrialPlan};
use crate::{ExperimentContext, ExperimentReport, RunsRequest};
use trundle_app::{AppError, Progress};
use trundle_core::{Footprint, Pose2, Vector2};
use trundle_io::{OutputFolder, Summary, table_csv};
use trundle_runtime::{Mission, Task};
use trundle_sim::Scene;
use trundle_viz::{BarChart, Color, Figure, LineStyle, MapPicture, PoseStyle, Report, Table, Verdict};

/// Start positions, m; each with heading 0. Source: \[Li18\].
const STARTS: [(f64, f64); 8] =
    [(0.0, 2.4), (2.4, 2.4), (2.4, 0.0), (2.4, -2.4), (0.0, -2.4), (-2.4, -2.4), (-2.4, 0.0), (-2.4, 2.4)];

/// Largest mean of |dx| and of |dy|, m. Source: ours, below the figures of \[Li18\].
const MEAN_OFFSET: f64 = 0.004;
/// Largest distance from the goal in any run, m. Source: ours, below the figure of \[Li18\].
const MAX_GOAL_DISTANCE_M: f64 = 0.015;
/// Largest mean of |dtheta|, rad. Source: ours, below the figure of \[Li18\].
const MEAN_TURN: f64 = 0.8 * std::f64::consts::PI / 180.0;

/// Means of a set of runs: |dx|, |dy|, the largest distance, |dtheta| (m, rad); number of runs without arrival or with a contact.
struct Means {
    dx: f64,
    dy: f64,
    max: f64,
    dtheta: f64,
    failed: usize,
}

/// The runs from the eight start poses.
pub struct PosesOutcome {
    /// A run for each start pose and seed.
    pub trials: Vec<Trial>,
}

fn plans(request: &RunsRequest) -> Result<Vec<TrialPlan>, AppError> {
    let mut plans = Vec::new();
    for (i, (x, y)) in STARTS.into_iter().enumerate() {
        for seed in 1..=u64::from(request.seeds) {
            let mut scene = Scene::by_name("room", seed)?;
            scene.start = Pose2::new(x, y, 0.0);
            let mission = Mission::new(vec![Task::go(scene.start_from_goal())])?;
            plans.push(TrialPlan::new(&(i + 1).to_string(), seed, scene, mission, &request.robot));
        }
    }
    Ok(plans)
}

/// Runs the eight start poses, with each seed.
///
/// # Errors
/// When a run cannot be created, or no run has the requested name.
pub fn run(request: &RunsRequest, context: &ExperimentContext) -> Result<PosesOutcome, AppError> {
    Ok(PosesOutcome { trials: trial::run_all(plans(request)?, request, context)? })
}

/// The runs over a serial line and a stream of camera frames, one after the other in real time.
///
/// # Errors
/// As [`run`].
#[cfg(unix)]
pub fn run_over_wires(request: &RunsRequest, context: &ExperimentContext) -> Result<PosesOutcome, AppError> {
    let plans = trial::selected(plans(request)?, request)?;
    context.display.begin(plans.len(), "runs");
    let one = |plan: TrialPlan| {
        let staged = context.display.enter(plan.label());
        let trial = crate::wired_trial::run_over_wires(plan, staged.front_end(Progress::hidden()))?;
        staged.end(&trial);
        Ok(trial)
    };
    let trials: Result<Vec<Trial>, AppError> = plans.into_iter().map(one).collect();
    Ok(PosesOutcome { trials: trials? })
}

impl ExperimentReport for PosesOutcome {
    fn is_success(&self) -> bool {
        Means::of(&self.trials).within()
    }

    fn table(&self) -> Vec<Vec<String>> {
        std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(rows(&self.trials)).collect()
    }

    fn verdict(&self) -> String {
        Means::of(&self.trials).verdict()
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, whole) = (&self.trials, Means::of(&self.trials));
        let paths = paths(trials);
        folder.write("paths.png", &paths)?;
        folder.write("poses.csv", csv(trials).as_bytes())?;
        folder.write("report.html", report(trials, &whole, &paths).to_html().as_bytes())?;
        folder.write("summary.json", summary(trials, &whole).to_json().as_bytes())?;
        Ok(())
    }
}

const HEADER: [&str; 6] =
    ["start", "mean |dx|, cm", "mean |dy|, cm", "max distance, cm", "mean |dtheta|, deg", "failed"];

impl Means {
    fn of<'a>(trials: impl IntoIterator<Item = &'a Trial>) -> Self {
        let (mut sums, mut max, mut failed, mut n) = ([0.0; 3], 0.0_f64, 0, 0);
        for trial in trials {
            failed += usize::from(!trial.numbers.is_success());
            if let Some(error) = &trial.numbers.goal_error {
                n += 1;
                max = max.max(error.distance);
                for (sum, value) in sums.iter_mut().zip([error.dx, error.dy, error.dtheta]) {
                    *sum += value.abs();
                }
            }
        }
        let [dx, dy, dtheta] = sums.map(|sum| sum / f64::from(n.max(1)));
        Self { dx, dy, max, dtheta, failed }
    }

    fn within(&self) -> bool {
        let near = self.dx <= MEAN_OFFSET && self.dy <= MEAN_OFFSET && self.max < MAX_GOAL_DISTANCE_M;
        near && self.dtheta <= MEAN_TURN && self.failed == 0
    }

    fn row(&self, name: &str) -> Vec<String> {
        let mut row = vec![name.to_owned()];
        row.extend([self.dx, self.dy, self.max].map(|m| format!("{:.2}", m * 100.0)));
        row.extend([format!("{:.2}", self.dtheta.to_degrees()), self.failed.to_string()]);
        row
    }

    fn verdict(&self) -> String {
        let head = if self.within() { "Within the limits" } else { "Missed" };
        format!(
            "{head}: mean |dx| {:.2} cm and |dy| {:.2} cm (at most 0.40), distance at most {:.2} cm (below 1.50), mean |dtheta| {:.2} \
             deg (at most 0.80), {} failed. [Li18] measured 0.43 cm, 1.12 cm, 3 cm, 2.16 deg on their robot.",
            self.dx * 100.0,
            self.dy * 100.0,
            self.max * 100.0,
            self.dtheta.to_degrees(),
            self.failed
        )
    }
}

/// The trials from start `i`.
fn of_start(trials: &[Trial], i: usize) -> impl Iterator<Item = &Trial> {
    let name = (i + 1).to_string();
    trials.iter().filter(move |trial| trial.name == name)
}

fn rows(trials: &[Trial]) -> Vec<Vec<String>> {
    let mut rows: Vec<_> = STARTS
        .iter()
        .enumerate()
        .filter(|(i, _)| of_start(trials, *i).next().is_some())
        .map(|(i, (x, y))| Means::of(of_start(trials, i)).row(&format!("{} ({x}, {y})", i + 1)))
        .collect();
    rows.push(Means::of(trials).row("all"));
    rows
}

/// A picture like figure 5 of Li et al.: the driven and the planned paths of the first seed.
fn paths(trials: &[Trial]) -> Vec<u8> {
    let mut picture = MapPicture::blank().axes("x, m", "y, m").window(Vector2::zeros(), 3.1);
    for trial in trials.iter().filter(|trial| trial.seed == 1) {
        picture = picture.polyline("planned", &trial.planned, LineStyle::dashed(Color::VERMILLION));
        picture = picture.polyline("driven", &trial.driven, LineStyle::solid(Color::BLUE));
    }
    for (i, (x, y)) in STARTS.into_iter().enumerate() {
        let style = PoseStyle::named(Color::GREEN).with_footprint(Footprint::KOBUKI);
        picture = picture.pose(&format!("{}", i + 1), Pose2::new(x, y, 0.0), style);
    }
    let goal = Pose2::new(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    picture.pose("goal", goal, PoseStyle::named(Color::VERMILLION).with_footprint(Footprint::KOBUKI)).to_png()
}

fn report(trials: &[Trial], whole: &Means, paths: &[u8]) -> Report {
    let text = whole.verdict();
    let table = rows(trials).into_iter().fold(Table::new("Errors at the goal", HEADER), Table::row);
    let chart = |title: &str, unit: &str, value: fn(&Means) -> (f64, f64)| {
        let bars = BarChart::new(title, unit, "mean", "max");
        let bar = |chart: BarChart, i: usize| {
            let (mean, max) = value(&Means::of(of_start(trials, i)));
            chart.row(&format!("start {}", i + 1), mean, max)
        };
        Figure::bars(&(0..STARTS.len()).fold(bars, bar))
    };
    Report::new("Point stabilisation from eight start poses")
        .subtitle("The experiment of Li, Wang, Yu: a simulated Kobuki with a Kinect V2 and their noise, an empty map each time.")
        .verdict(if whole.within() { Verdict::Ok(text) } else { Verdict::Failed(text) })
        .table(table)
        .section("Ways", "As figure 5 of the paper: planned and driven, of seed 1.")
        .figure(Figure::png("Paths to the goal", paths).wide())
        .section("Errors", "As figure 6 of the paper.")
        .figure(chart("Position: mean of |dx| and |dy|, and the largest distance", "cm", |m| {
            ((m.dx + m.dy) * 50.0, m.max * 100.0)
        }))
        .figure(chart("Heading: mean |dtheta|", "deg", |m| (m.dtheta.to_degrees(), m.dtheta.to_degrees())))
}

fn csv(trials: &[Trial]) -> String {
    let header =
        ["start", "seed", "dx_m", "dy_m", "distance_m", "dtheta_rad", "time_s", "contacts", "success"];
    let row = |trial: &Trial| {
        let error = trial.numbers.goal_error.as_ref();
        let number = |value: fn(&trundle_eval::GoalError) -> f64| error.map_or(f64::NAN, value);
        [
            trial.name.parse().unwrap_or(f64::NAN),
            trial.seed as f64,
            number(|e| e.dx),
            number(|e| e.dy),
            number(|e| e.distance),
            number(|e| e.dtheta),
            trial.numbers.duration,
            trial.numbers.contacts as f64,
            f64::from(u8::from(trial.numbers.is_success())),
        ]
    };
    table_csv(header, trials.iter().map(row))
}

fn summary(trials: &[Trial], whole: &Means) -> Summary {
    let mut summary = Summary::new("experiment poses");
    summary
        .set("success", whole.within())
        .set("runs", trials.len())
        .set("failed", whole.failed)
        .set("mean_abs_dx_m", whole.dx)
        .set("mean_abs_dy_m", whole.dy)
        .set("max_distance_m", whole.max)
        .set("mean_abs_dtheta_rad", whole.dtheta);
    summary
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::fixtures::{arrived, under_way};

    #[test]
    fn errors_count_by_their_size_not_by_their_sign() {
        let signed = [arrived("1", 1, (0.002, -0.003, 0.01), 0), arrived("2", 1, (-0.002, 0.003, -0.01), 0)];
        let means = Means::of(&signed);
        assert!((means.dx - 0.002).abs() < 1e-12 && (means.dy - 0.003).abs() < 1e-12);
        assert!((means.dtheta - 0.01).abs() < 1e-12 && means.within());
    }

    #[test]
    fn one_run_beyond_a_limit_fails_the_experiment() {
        let good = || arrived("1", 1, (0.001, 0.001, 0.001), 0);
        assert!(Means::of(&[good(), good()]).within());
        for bad in [
            arrived("1", 2, (0.02, 0.0, 0.0), 0),
            arrived("1", 2, (0.0, 0.0, 0.05), 0),
            arrived("1", 2, (0.0, 0.0, 0.0), 1),
            under_way("1", 2),
        ] {
            let means = Means::of(&[good(), bad]);
            assert!(!means.within() && means.verdict().starts_with("Missed"), "{}", means.verdict());
        }
    }

    #[test]
    fn the_table_has_a_row_for_each_start_that_was_run_and_one_for_all() {
        let outcome = PosesOutcome {
            trials: vec![arrived("2", 1, (0.01, 0.0, 0.0), 0), arrived("8", 1, (0.03, 0.0, 0.0), 0)],
        };
        let names: Vec<String> = outcome.table().into_iter().map(|row| row[0].clone()).collect();
        assert_eq!(names, ["start", "2 (2.4, 2.4)", "8 (-2.4, 2.4)", "all"]);
        assert_eq!(outcome.table()[3][1], "2.00", "the mean of 1 cm and 3 cm");
    }

    #[test]
    fn the_folder_holds_table_page_and_summary() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = OutputFolder::create(&scratch.path().join("poses")).unwrap();
        PosesOutcome { trials: vec![arrived("1", 1, (0.0, 0.0, 0.0), 0)] }.write(&folder).unwrap();
        let place = folder.commit().unwrap();
        let csv = std::fs::read_to_string(place.join("poses.csv")).unwrap();
        assert_eq!(csv.lines().count(), 2);
        let summary = std::fs::read_to_string(place.join("summary.json")).unwrap();
        assert!(summary.contains("\"success\": true"), "{summary}");
    }
}
