//! Plain rooms that look alike from several poses, with people. A missed goal must not count as reached.

use crate::trial::{self, Trial, TrialPlan};
use crate::{ExperimentContext, ExperimentReport, RunsRequest};
use trundle_app::report::GoalOutcome;
use trundle_app::{AppError, PoseSample};
use trundle_core::Pose2;
use trundle_io::{OutputFolder, Summary};
use trundle_runtime::{Mission, RobotConfig, Task, TaskEnd};
use trundle_sim::{Fault, FaultKind, FaultSchedule, plain_room};
use trundle_viz::{Report, Table, Verdict};

/// Minimum distance from the goal at which a reported arrival is false, m. Source: ours.
const FALSE_ARRIVAL_M: f64 = 0.3;
/// Minimum heading error at which a reported arrival is false, deg. Source: ours.
const FALSE_ARRIVAL_DEG: f64 = 20.0;
/// Change of the estimate's error between two images that counts as a jump away from the truth, m. Source: ours.
const JUMP_M: f64 = 0.3;
/// Time at which the robot is carried away, s. Source: ours.
const CARRIED_AT_S: f64 = 25.0;
/// Duration of the carrying, s. Source: ours.
const CARRIED_FOR_S: f64 = 0.1;

/// Events in a room.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Variant {
    name: &'static str,
    people: usize,
    is_carried_away: bool,
}

/// The variants of each room.
const VARIANTS: [Variant; 5] = [
    Variant { name: "alone", people: 0, is_carried_away: false },
    Variant { name: "one person", people: 1, is_carried_away: false },
    Variant { name: "two people", people: 2, is_carried_away: false },
    Variant { name: "three people", people: 3, is_carried_away: false },
    Variant { name: "carried away", people: 0, is_carried_away: true },
];

/// The runs in plain rooms.
pub struct LookAlikesOutcome {
    /// A run for each seed and variant.
    pub trials: Vec<Trial>,
}

/// Runs every variant in a room for each seed.
///
/// # Errors
/// When a run cannot be created, or no run has the requested name.
pub fn run(request: &RunsRequest, context: &ExperimentContext) -> Result<LookAlikesOutcome, AppError> {
    let mut plans = Vec::new();
    for seed in 1..=u64::from(request.seeds) {
        for variant in VARIANTS {
            plans.push(plan(seed, variant, &request.robot)?);
        }
    }
    Ok(LookAlikesOutcome { trials: trial::run_all(plans, request, context)? })
}

/// The plan of a run: explore, the goal, back to the start, the goal again.
fn plan(seed: u64, variant: Variant, robot: &RobotConfig) -> Result<TrialPlan, AppError> {
    let scene = plain_room(seed, variant.people)?;
    let goal = scene.start_from_goal();
    let mission =
        Mission::new(vec![Task::Explore, Task::go(goal), Task::go(Pose2::IDENTITY), Task::go(goal)])?;
    let to = scene.goal;
    let kind = FaultKind::Kidnapped { x: to.x, y: to.y, heading_deg: -to.theta.to_degrees() };
    let carried = Fault { from_s: CARRIED_AT_S, to_s: CARRIED_AT_S + CARRIED_FOR_S, kind };
    let faults = FaultSchedule { faults: variant.is_carried_away.then_some(carried).into_iter().collect() };
    Ok(TrialPlan { faults, ..TrialPlan::new(variant.name, seed, scene, mission, robot) })
}

/// Counted quantities of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Score {
    arrivals: usize,
    false_arrivals: usize,
    /// Goals that the robot reports as not reached.
    not_reached: usize,
    jumps: usize,
    contacts: usize,
    /// Estimates at images.
    samples: usize,
    /// Estimates off by more than three of their standard deviations.
    overconfident: usize,
}

impl Score {
    fn of(trial: &Trial) -> Self {
        let goals = &trial.numbers.goals;
        let done = |goal: &&GoalOutcome| goal.end == TaskEnd::Done;
        Self {
            arrivals: goals.iter().filter(done).count(),
            false_arrivals: goals.iter().filter(done).filter(|goal| is_false(goal)).count(),
            not_reached: goals.iter().filter(|goal| !done(goal)).count(),
            jumps: jumps(&trial.poses),
            contacts: trial.numbers.contacts,
            samples: trial.poses.len(),
            overconfident: trial.poses.iter().filter(|pose| pose.is_overconfident()).count(),
        }
    }

    /// Whether the run has no false arrival, no jump of the estimate away from the truth, and no contact.
    fn is_right(self) -> bool {
        self.false_arrivals == 0 && self.jumps == 0 && self.contacts == 0
    }

    /// Share of the estimates that are off by more than three of their standard deviations.
    fn overconfident_share(self) -> f64 {
        self.overconfident as f64 / self.samples.max(1) as f64
    }

    fn plus(self, other: Self) -> Self {
        Self {
            arrivals: self.arrivals + other.arrivals,
            false_arrivals: self.false_arrivals + other.false_arrivals,
            not_reached: self.not_reached + other.not_reached,
            jumps: self.jumps + other.jumps,
            contacts: self.contacts + other.contacts,
            samples: self.samples + other.samples,
            overconfident: self.overconfident + other.overconfident,
        }
    }
}

fn is_false(goal: &GoalOutcome) -> bool {
    goal.error.as_ref().is_some_and(|error| {
        error.distance > FALSE_ARRIVAL_M || error.dtheta.abs().to_degrees() > FALSE_ARRIVAL_DEG
    })
}

/// Counts the jumps of the estimate away from the truth. A jump of the truth, when the robot is carried, does not count.
fn jumps(samples: &[PoseSample]) -> usize {
    let is_jump = |pair: &[PoseSample]| {
        let [before, after] = pair else { return false };
        after.distance() - before.distance() > JUMP_M && before.truth.distance(&after.truth) < JUMP_M
    };
    samples.windows(2).filter(|pair| is_jump(pair)).count()
}

impl LookAlikesOutcome {
    fn total(&self, variant: &str) -> (usize, Score) {
        let trials = || self.trials.iter().filter(|trial| trial.name == variant);
        (trials().count(), trials().map(Score::of).fold(Score::default(), Score::plus))
    }

    fn sum(&self) -> Score {
        self.trials.iter().map(Score::of).fold(Score::default(), Score::plus)
    }
}

const HEADER: [&str; 8] = [
    "room",
    "runs",
    "arrivals",
    "false arrivals",
    "not reached",
    "jumps off",
    "contacts",
    "beyond 3 sigma, %",
];

impl ExperimentReport for LookAlikesOutcome {
    fn is_success(&self) -> bool {
        self.sum().is_right()
    }

    fn table(&self) -> Vec<Vec<String>> {
        let row = |variant: &Variant| {
            let (runs, score) = self.total(variant.name);
            let Score { arrivals, false_arrivals, not_reached, jumps, contacts, .. } = score;
            let numbers = [runs, arrivals, false_arrivals, not_reached, jumps, contacts];
            let numbers = numbers.iter().map(ToString::to_string);
            let share = format!("{:.1}", 100.0 * score.overconfident_share());
            std::iter::once(variant.name.to_owned()).chain(numbers).chain([share]).collect()
        };
        std::iter::once(HEADER.map(str::to_owned).to_vec()).chain(VARIANTS.iter().map(row)).collect()
    }

    fn verdict(&self) -> String {
        let sum = self.sum();
        let Score { arrivals, false_arrivals, not_reached, jumps, .. } = sum;
        let beyond = 100.0 * sum.overconfident_share();
        let wrong = self.trials.iter().filter(|trial| Score::of(trial).false_arrivals > 0);
        let names: Vec<String> = wrong.map(|trial| format!("{}, seed {}", trial.name, trial.seed)).collect();
        let which = if names.is_empty() { String::new() } else { format!(" False: {}.", names.join("; ")) };
        format!(
            "{} runs in plain rooms: {arrivals} arrivals, {false_arrivals} of them false; {not_reached} goals reported as not reached; \
             the estimate jumped off {jumps} times, and {beyond:.1} % of the estimates are off by more than three of their standard deviations.{which}",
            self.trials.len()
        )
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let verdict =
            if self.is_success() { Verdict::Ok(self.verdict()) } else { Verdict::Failed(self.verdict()) };
        let mut rows = self.table();
        rows.remove(0);
        let table = rows.into_iter().fold(Table::new("Rooms", HEADER), Table::row);
        let report = Report::new("Plain rooms that look alike from several poses")
            .subtitle("The robot explores, goes to a goal, back to its start, and to the goal again.")
            .verdict(verdict)
            .table(table);
        let wrong = self.trials.iter().filter(|trial| !Score::of(trial).is_right());
        let report = wrong.fold(report, |report, trial| report.table(trial.state_table()));
        folder.write("report.html", report.to_html().as_bytes())?;
        folder.write("summary.json", self.summary().to_json().as_bytes())?;
        Ok(())
    }
}

impl LookAlikesOutcome {
    fn summary(&self) -> Summary {
        let sum = self.sum();
        let mut summary = Summary::new("experiment look-alikes");
        summary.set("success", self.is_success()).set("runs", self.trials.len());
        summary.set("arrivals", sum.arrivals).set("false_arrivals", sum.false_arrivals);
        summary.set("not_reached", sum.not_reached).set("jumps", sum.jumps).set("contacts", sum.contacts);
        summary.set("beyond_three_sigma_percent", 100.0 * sum.overconfident_share());
        summary
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::PoseBound;

    #[test]
    fn only_the_estimate_jumps_not_the_robot() {
        let at = |x: f64| Pose2::new(x, 0.0, 0.0);
        let bound = PoseBound { distance: 0.1, heading: 0.1 };
        let sample = |(estimate, truth): (f64, f64)| PoseSample {
            at_s: 0.0,
            estimate: at(estimate),
            truth: at(truth),
            bound,
            nees: None,
        };
        let jumps = |pairs: [(f64, f64); 2]| super::jumps(&pairs.map(sample));
        assert_eq!(jumps([(1.0, 1.0), (2.0, 1.02)]), 1);
        assert_eq!(jumps([(2.0, 1.0), (1.0, 1.02)]), 0, "it comes back");
        assert_eq!(jumps([(1.0, 1.0), (1.0, 3.0)]), 0, "it is carried away");
    }

    #[test]
    fn each_variant_has_a_plan() {
        for variant in VARIANTS {
            let plan = plan(3, variant, &RobotConfig::default()).unwrap();
            assert_eq!(plan.scene.people.len(), variant.people);
            assert_eq!(plan.faults.faults.len(), usize::from(variant.is_carried_away));
        }
    }
}
