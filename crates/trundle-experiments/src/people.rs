//! People who step into the robot's path one metre ahead. The robot stops, waits or drives around them, without a contact.

use crate::trial::{self, Trial, TrialPlan};
use crate::{ExperimentContext, ExperimentReport, RunsRequest};
use trundle_app::{AppError, stop};
use trundle_core::{Pose2, Vector2};
use trundle_io::{OutputFolder, Summary, table_csv};
use trundle_runtime::{Mission, RobotConfig, Task};
use trundle_sim::{Person, Scene};
use trundle_viz::{Report, Table, Verdict};

/// Start of the robot's crossing, world frame, m. Source: ours.
const START_XY_M: (f64, f64) = (-2.4, 0.0);
/// Goal of the robot's crossing, world frame, m. Source: ours.
const GOAL_XY_M: (f64, f64) = (2.0, 0.0);
/// Distance between the robot's front and a person who steps onto its path, m. Source: ours.
const ENCOUNTER_DISTANCE_M: f64 = 1.0;
/// Range of the encounter along the path from its start, m: the robot drives at full speed there. Source: ours.
const ENCOUNTER_PATH_RANGE_M: (f64, f64) = (1.9, 3.6);
/// Range of the lateral distance between the path and the person's start, m. Source: ours.
const SIDE_OFFSET_RANGE_M: (f64, f64) = (0.8, 1.2);
/// Range of walking speeds, m/s. Source: ours.
const WALKING_SPEED_RANGE_M_S: (f64, f64) = (0.7, 1.6);
/// Range of the time that the person stands on the path, s. Source: ours.
const STAY_RANGE_S: (f64, f64) = (0.0, 4.0);

/// A person who steps out: distance along the path and beside it (left is positive), m; walking speed, m/s; time on the path, s.
#[derive(Debug, Clone, Copy)]
struct StepOut {
    x: f64,
    beside: f64,
    speed: f64,
    stay: f64,
}

impl StepOut {
    /// Point of a low-discrepancy sequence: the additive recurrence of the plastic number's powers (Roberts 2018).
    fn of(seed: u64) -> Self {
        let draw = |power: i32, (low, high): (f64, f64)| {
            let part = (seed as f64 * 1.167_303_978_261_418_7_f64.powi(-power)).fract();
            low + (high - low) * part
        };
        let side = if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
        Self {
            x: START_XY_M.0 + draw(1, ENCOUNTER_PATH_RANGE_M),
            beside: side * draw(2, SIDE_OFFSET_RANGE_M),
            speed: draw(3, WALKING_SPEED_RANGE_M_S),
            stay: draw(4, STAY_RANGE_S),
        }
    }

    /// The person who steps onto the path when the robot is [`ENCOUNTER_DISTANCE_M`] away by `timetable`.
    fn person(&self, timetable: &[(f64, Vector2)], radius: f64) -> Person {
        let robot_at = self.x - ENCOUNTER_DISTANCE_M - radius;
        let on_the_way = timetable.iter().find(|(_, at)| at.x >= robot_at).map_or(0.0, |(time, _)| *time);
        Person {
            waypoints: vec![[self.x, self.beside], [self.x, 0.0], [self.x, -self.beside]],
            speed: self.speed,
            delay: (on_the_way - self.beside.abs() / self.speed).max(0.0),
            pause: self.stay,
            once: true,
            ..Person::default()
        }
    }
}

/// The runs in which a person steps into the robot's path.
pub struct PeopleOutcome {
    /// A run for each person.
    pub trials: Vec<Trial>,
}

/// Runs with one person each; each seed is another person.
///
/// # Errors
/// When a run cannot be created, or no run has the requested name.
pub fn run(request: &RunsRequest, context: &ExperimentContext) -> Result<PeopleOutcome, AppError> {
    let robot = &request.robot;
    let radius = robot.footprint()?.circumscribed_radius();
    let alone = plan("alone", 1, robot)?;
    let alone = run_alone(alone, context)?;
    let timetable: Vec<(f64, Vector2)> = alone.times.iter().copied().zip(alone.driven).collect();
    let mut plans = Vec::new();
    for seed in 1..=u64::from(request.seeds) {
        let mut plan = plan(&format!("run {seed}"), seed, robot)?;
        plan.scene.people.push(StepOut::of(seed).person(&timetable, radius));
        plans.push(plan);
    }
    Ok(PeopleOutcome { trials: trial::run_all(plans, request, context)? })
}

/// Executes the run without a person, whose timetable controls the persons. Every shard executes this run.
fn run_alone(plan: TrialPlan, context: &ExperimentContext) -> Result<Trial, AppError> {
    let ExperimentContext { display, runs } = context;
    let name = plan.label();
    let staged = display.enter(name.clone());
    let alone = runs.result(&name, || trial::run_one(plan, staged.link()).map(Some))?;
    let Some(alone) = alone.filter(|_| stop::stopped().is_none()) else { return Err(AppError::Stopped) };
    runs.keep(&name, &alone)?;
    Ok(alone)
}

impl ExperimentReport for PeopleOutcome {
    fn is_success(&self) -> bool {
        self.trials.iter().all(is_good)
    }

    fn table(&self) -> Vec<Vec<String>> {
        Vec::new()
    }

    fn verdict(&self) -> String {
        verdict(&self.trials)
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (trials, success) = (&self.trials, self.is_success());
        folder.write("people.csv", csv(trials).as_bytes())?;
        folder.write("report.html", report(trials, success).to_html().as_bytes())?;
        folder.write("summary.json", summary(trials, success).to_json().as_bytes())?;
        Ok(())
    }
}

/// The plan of a drive across the room, without people.
fn plan(name: &str, seed: u64, robot: &RobotConfig) -> Result<TrialPlan, AppError> {
    let mut scene = Scene::by_name("room", seed)?;
    scene.start = Pose2::new(START_XY_M.0, START_XY_M.1, 0.0);
    scene.goal = Pose2::new(GOAL_XY_M.0, GOAL_XY_M.1, 0.0);
    let mission = Mission::new(vec![Task::go(scene.start_from_goal())])?;
    Ok(TrialPlan::new(name, seed, scene, mission, robot))
}

fn is_good(trial: &Trial) -> bool {
    trial.numbers.is_success()
}

fn verdict(trials: &[Trial]) -> String {
    let contacts = trials.iter().filter(|trial| trial.numbers.contacts > 0).count();
    let arrived = trials.iter().filter(|trial| is_good(trial)).count();
    let bad: Vec<&str> =
        trials.iter().filter(|trial| !is_good(trial)).map(|trial| trial.name.as_str()).take(20).collect();
    let which = if bad.is_empty() { String::new() } else { format!(" Not so: {}.", bad.join(", ")) };
    format!(
        "In {} runs somebody stepped out {ENCOUNTER_DISTANCE_M} m before the robot: {contacts} with a contact, {arrived} arrived untouched.{which}",
        trials.len()
    )
}

fn csv(trials: &[Trial]) -> String {
    let header = ["run", "x_m", "beside_m", "speed_m_s", "stay_s", "contacts", "arrived", "time_s"];
    let rows = trials.iter().map(|trial| {
        let StepOut { x, beside, speed, stay } = StepOut::of(trial.seed);
        let numbers = &trial.numbers;
        let arrived = f64::from(u8::from(is_good(trial)));
        [trial.seed as f64, x, beside, speed, stay, numbers.contacts as f64, arrived, numbers.duration]
    });
    table_csv(header, rows)
}

const HEADER: [&str; 6] = ["run", "on the path at x, m", "from the side, m", "speed, m/s", "contacts", "end"];

fn report(trials: &[Trial], success: bool) -> Report {
    let verdict = if success { Verdict::Ok(verdict(trials)) } else { Verdict::Failed(verdict(trials)) };
    let row = |trial: &Trial| {
        let StepOut { x, beside, speed, .. } = StepOut::of(trial.seed);
        let numbers = [format!("{x:.2}"), format!("{beside:.2}"), format!("{speed:.2}")];
        let [x, beside, speed] = numbers;
        vec![
            trial.name.clone(),
            x,
            beside,
            speed,
            trial.numbers.contacts.to_string(),
            trial.numbers.end.state.to_string(),
        ]
    };
    let bad = trials.iter().filter(|trial| !is_good(trial));
    let table = bad.map(row).fold(Table::new("Runs that did not end as they should", HEADER), Table::row);
    Report::new("People who step out")
        .subtitle("A robot crosses a room at full speed; a person steps onto its path 1 m ahead.")
        .verdict(verdict)
        .table(table.wide())
}

fn summary(trials: &[Trial], success: bool) -> Summary {
    let mut summary = Summary::new("experiment people");
    summary.set("success", success).set("runs", trials.len());
    summary.set("runs_with_contact", trials.iter().filter(|trial| trial.numbers.contacts > 0).count());
    summary.set("arrived", trials.iter().filter(|trial| is_good(trial)).count());
    summary
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial::fixtures::arrived;

    #[test]
    fn they_are_on_the_way_when_the_robot_is_a_metre_before_them() {
        // A robot that drives 1 m in 2 s.
        let point = |i: i32| (f64::from(i) * 0.1, Vector2::new(START_XY_M.0 + f64::from(i) * 0.05, 0.0));
        let timetable: Vec<_> = (0..100).map(point).collect();
        for seed in 1..50 {
            let step = StepOut::of(seed);
            let person = step.person(&timetable, 0.2);
            let there = person.delay + step.beside.abs() / step.speed;
            let robot = START_XY_M.0 + there * 0.5;
            assert!((step.x - robot - 0.2 - ENCOUNTER_DISTANCE_M).abs() < 0.06, "{step:?} {person:?}");
            assert!((START_XY_M.0..=GOAL_XY_M.0).contains(&step.x));
        }
    }

    #[test]
    fn people_come_from_both_sides_within_their_ranges() {
        let steps: Vec<StepOut> = (1..=40).map(StepOut::of).collect();
        assert_eq!(steps.iter().filter(|step| step.beside > 0.0).count(), 20);
        for step in steps {
            assert!((SIDE_OFFSET_RANGE_M.0..=SIDE_OFFSET_RANGE_M.1).contains(&step.beside.abs()), "{step:?}");
            assert!(
                (WALKING_SPEED_RANGE_M_S.0..=WALKING_SPEED_RANGE_M_S.1).contains(&step.speed),
                "{step:?}"
            );
            assert!((STAY_RANGE_S.0..=STAY_RANGE_S.1).contains(&step.stay), "{step:?}");
        }
    }

    #[test]
    fn the_verdict_names_the_runs_that_failed() {
        let good = arrived("run 1", 1, (0.0, 0.0, 0.0), 0);
        let touched = arrived("run 2", 2, (0.0, 0.0, 0.0), 1);
        let outcome = PeopleOutcome { trials: vec![good, touched] };
        assert!(!outcome.is_success());
        let text = outcome.verdict();
        assert!(text.contains("In 2 runs") && text.contains("1 with a contact, 1 arrived"), "{text}");
        assert!(text.contains("run 2") && !text.contains("run 1,"), "{text}");
        assert_eq!(csv(&outcome.trials).lines().count(), 3);
    }

    #[test]
    fn a_run_without_contact_is_a_success() {
        let outcome = PeopleOutcome { trials: vec![arrived("run 1", 1, (0.0, 0.0, 0.0), 0)] };
        assert!(outcome.is_success() && !outcome.verdict().contains("run 1"), "{}", outcome.verdict());
    }
}
