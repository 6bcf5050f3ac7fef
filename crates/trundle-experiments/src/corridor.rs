//! The four corridor scenarios of Hong (2024), by the paper's method and by the optimal one.

use crate::ExperimentReport;
use trundle_app::dock::{DockingObstacles, manoeuvre_picture, motions, step_pictures, steps_csv, view};
use trundle_app::{AppError, stop};
use trundle_core::{Pose2, Vector2, difference_of_angles};
use trundle_docking::corridor::{Problem, Scenario};
use trundle_docking::{DockingConfig, DockingPlan, DockingPlanner, Method, Solution};
use trundle_io::{OutputFolder, Summary, table_csv};
use trundle_viz::{Figure, MapPicture, Report, Table, Verdict, tiles};

/// A scenario solved by a method.
pub struct CorridorTrial {
    scenario: Scenario,
    method: &'static str,
    problem: Problem,
    plan: DockingPlan,
}

/// The four scenarios, each by both methods.
pub struct CorridorOutcome {
    /// A solution for each scenario and method.
    pub trials: Vec<CorridorTrial>,
}

/// Solves the four scenarios by both methods.
///
/// # Errors
/// When the planner refuses a scenario.
pub fn run() -> Result<CorridorOutcome, AppError> {
    Ok(CorridorOutcome { trials: trials()? })
}

impl ExperimentReport for CorridorOutcome {
    fn is_success(&self) -> bool {
        self.trials.len() == 2 * Scenario::ALL.len() && self.trials.iter().all(CorridorTrial::is_good)
    }

    fn table(&self) -> Vec<Vec<String>> {
        std::iter::once(HEADER.map(str::to_owned).to_vec())
            .chain(self.trials.iter().map(CorridorTrial::row))
            .collect()
    }

    fn verdict(&self) -> String {
        verdict(self.is_success())
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, success) = (&self.trials, self.is_success());
        let view = common_view(trials);
        let all = together(trials, view);
        let mut report =
            report(trials, success).figure(Figure::png("corridor", &all).caption("All of them."));
        for trial in trials {
            let (name, png) = (trial.name(), trial.picture(view).to_png());
            folder.write(&format!("{name}.png"), &png)?;
            if let Some(found) = trial.found() {
                folder.write(&format!("{name}.csv"), steps_csv(&found.manoeuvre).as_bytes())?;
                folder.write(&format!("{name}-steps.png"), &trial.steps(found, view))?;
            }
            report = report.figure(Figure::png(&name, &png).caption(&trial.text()));
        }
        folder.write("corridor.csv", csv(trials).as_bytes())?;
        folder.write("corridor.png", &all)?;
        folder.write("report.html", report.to_html().as_bytes())?;
        folder.write("summary.json", summary(trials, success).to_json().as_bytes())?;
        Ok(())
    }
}

const HEADER: [&str; 5] = ["scenario", "method", "time", "bound", "motions"];

fn trials() -> Result<Vec<CorridorTrial>, AppError> {
    let mut trials = Vec::new();
    for scenario in Scenario::ALL {
        for (method, name) in [(Method::Hong24, "paper"), (Method::Optimal, "optimal")] {
            if stop::is_requested(|| format!("{} of 8 plans", trials.len())) {
                return if trials.is_empty() { Err(AppError::Stopped) } else { Ok(trials) };
            }
            let mut config = DockingConfig::default();
            config.method = method;
            let docker = DockingPlanner::new(config)?;
            let problem = scenario.problem();
            let plan = docker
                .plan(&problem.footprint, &problem.scene()?, problem.start, problem.goal)
                .map_err(|refusal| AppError::Input(format!("{}: {refusal}", problem.name)))?;
            trials.push(CorridorTrial { scenario, method: name, problem, plan });
        }
    }
    Ok(trials)
}

impl CorridorTrial {
    fn found(&self) -> Option<&Solution> {
        match &self.plan {
            DockingPlan::Found(found) => Some(found),
            DockingPlan::Impossible(_) => None,
        }
    }

    /// Whether the end is within 1 cm and 1 deg of the goal; for the paper's method, also with the motions reported in the paper.
    fn is_good(&self) -> bool {
        self.found().is_some_and(|found| {
            let (end, goal) = (found.manoeuvre.end(), self.problem.goal);
            let is_there = end.distance(&goal) <= 0.01
                && difference_of_angles(end.theta, goal.theta).abs() <= 1_f64.to_radians();
            is_there && (self.method != "paper" || motions(&found.manoeuvre) == self.scenario.reported())
        })
    }

    fn name(&self) -> String {
        format!("{}-{}", self.scenario.letter(), self.method)
    }

    fn around(&self) -> DockingObstacles<'_> {
        DockingObstacles { grid: None, problem: Some(&self.problem) }
    }

    fn ends(&self) -> (Pose2, Pose2) {
        (self.problem.start, self.problem.goal)
    }

    fn picture(&self, (center, half): (Vector2, f64)) -> MapPicture<'_> {
        let footprint = &self.problem.footprint;
        manoeuvre_picture(self.around(), footprint, self.ends(), self.found(), None).window(center, half)
    }

    /// A picture of each motion.
    fn steps(&self, found: &Solution, (center, half): (Vector2, f64)) -> Vec<u8> {
        let pictures = step_pictures(self.around(), &self.problem.footprint, self.ends(), found);
        let pictures: Vec<_> =
            pictures.into_iter().map(|(title, picture)| (title, picture.window(center, half))).collect();
        tiles(&pictures, pictures.len())
    }

    fn text(&self) -> String {
        self.found().map_or("no manoeuvre".to_owned(), |found| {
            format!("{:.2} s: {}", found.manoeuvre.duration(), motions(&found.manoeuvre).join(", "))
        })
    }

    fn row(&self) -> Vec<String> {
        let seconds = |s: f64| if s > 0.0 { format!("{s:.2} s") } else { "-".to_owned() };
        let (time, bound) =
            self.found().map_or((0.0, 0.0), |found| (found.manoeuvre.duration(), found.bound));
        let words = self.found().map_or("none".to_owned(), |found| motions(&found.manoeuvre).join(", "));
        vec![self.scenario.letter().to_string(), self.method.to_owned(), seconds(time), seconds(bound), words]
    }
}

fn report(trials: &[CorridorTrial], success: bool) -> Report {
    let text = if success { Verdict::Ok(verdict(true)) } else { Verdict::Failed(verdict(false)) };
    let table = trials.iter().fold(Table::new("Scenarios", HEADER), |table, trial| table.row(trial.row()));
    Report::new("Fine positioning in a corridor")
        .subtitle(
            "The four corridor scenarios of Hong (2024): a robot of 0.6 x 0.4 m in a corridor of 1.0 m.",
        )
        .verdict(text)
        .table(table)
        .section("Manoeuvres", "Green: start. Red: goal. Light blue: the floor that the robot covers. Blue: its outline after each motion. Arrows: the motions in their order; of a turn, the way of a point ahead of the axle.")
}

/// The square that holds every manoeuvre: one scale for all pictures.
fn common_view(trials: &[CorridorTrial]) -> (Vector2, f64) {
    let views = trials.iter().map(|trial| view(&trial.problem.footprint, trial.ends(), trial.found()));
    let none = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
    let (low, high) = views.fold(none, |(low, high), (middle, half)| {
        (low.inf(&middle.add_scalar(-half)), high.sup(&middle.add_scalar(half)))
    });
    ((low + high) / 2.0, (high - low).amax() / 2.0)
}

/// The four scenarios side by side, with the paper's method in the upper row.
fn together(trials: &[CorridorTrial], view: (Vector2, f64)) -> Vec<u8> {
    let by = |method: &'static str| trials.iter().filter(move |trial| trial.method == method);
    let titled = |trial: &'_ CorridorTrial| {
        let seconds = trial.found().map_or(f64::NAN, |found| found.manoeuvre.duration());
        format!("({}) {}, {seconds:.1} s", trial.scenario.letter(), trial.method)
    };
    let pictures: Vec<_> =
        by("paper").chain(by("optimal")).map(|trial| (titled(trial), trial.picture(view))).collect();
    tiles(&pictures, Scenario::ALL.len())
}

fn verdict(success: bool) -> String {
    if success {
        "All four scenarios solved by both methods, the paper's with the motions it reports.".to_owned()
    } else {
        "A scenario was not solved, or not with the motions that the paper reports.".to_owned()
    }
}

fn csv(trials: &[CorridorTrial]) -> String {
    let row = |trial: &CorridorTrial| {
        let (time, bound) = trial.found().map_or((f64::NAN, f64::NAN), |f| (f.manoeuvre.duration(), f.bound));
        let number = Scenario::ALL.iter().position(|s| *s == trial.scenario).unwrap_or(0) + 1;
        [number as f64, f64::from(u8::from(trial.method == "optimal")), time, bound]
    };
    table_csv(["scenario", "optimal", "time_s", "bound_s"], trials.iter().map(row))
}

fn summary(trials: &[CorridorTrial], success: bool) -> Summary {
    let mut summary = Summary::new("experiment corridor");
    summary.set("success", success);
    for trial in trials {
        let words = trial.found().map(|found| motions(&found.manoeuvre));
        let time = trial.found().map_or(f64::NAN, |found| found.manoeuvre.duration());
        summary.set(&trial.name(), serde_json::json!({ "time_s": time, "motions": words }));
    }
    summary
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_optimal_method_takes_no_longer_than_the_papers() {
        let outcome = run().unwrap();
        let seconds = |trial: &CorridorTrial| trial.found().unwrap().manoeuvre.duration();
        for pair in outcome.trials.chunks(2) {
            assert_eq!((pair[0].method, pair[1].method), ("paper", "optimal"));
            let is_bounded = pair[1].found().unwrap().bound <= seconds(&pair[1]) + 1e-9;
            assert!(seconds(&pair[1]) <= seconds(&pair[0]) + 1e-9 && is_bounded, "{}", pair[1].name());
        }
    }

    #[test]
    fn another_manoeuvre_than_the_papers_fails() {
        let mut outcome = run().unwrap();
        assert!(outcome.is_success());
        let other = outcome.trials.remove(3).plan;
        outcome.trials[0].plan = other;
        assert!(!outcome.is_success() && outcome.verdict() == verdict(false));
    }

    #[test]
    fn the_table_names_scenario_and_method() {
        let table = run().unwrap().table();
        assert_eq!(table.len(), 9);
        assert_eq!((table[1][0].as_str(), table[1][1].as_str()), ("a", "paper"));
        assert_eq!(table[1][3], "-", "the paper's method has no bound");
    }
}
