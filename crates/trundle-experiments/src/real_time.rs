//! A run in real time over many minutes: jitter of control, CPU load of a core, and growth of memory.

use crate::simulated::{SimulatedRealTimeBody, simulated_real_time_body};
use crate::{ExperimentContext, ExperimentReport};
use trundle_app::real_time::{RealTimeReport, run_in_real_time};
use trundle_app::{AppError, FinishedRun, RunLog, RunSetup};
use trundle_io::{OutputFolder, Summary, table_csv};
use trundle_runtime::{Mission, RobotConfig, Task, TaskEnd, TaskRecord};
use trundle_sim::{FaultSchedule, Scene, Simulator};
use trundle_viz::{Chart, Color, Figure, Report, Table, Verdict};

/// Largest jitter of 999 of 1000 commands, ms. Source: ours.
const JITTER_MS: f64 = 5.0;
/// Largest load of the robot's core by all threads, 0 to 1. Source: ours.
const MAX_CPU_LOAD: f64 = 0.6;
/// Largest growth of memory after maps and buffers have reached their size, MB/h. Source: ours.
const MAX_MEMORY_GROWTH_MB_PER_H: f64 = 10.0;
/// Time in which memory may grow while maps and buffers reach their size, s. Source: ours.
const MEMORY_SETTLING_S: f64 = 600.0;
/// Shortest run whose growth is evaluated, s. Source: ours.
const MIN_JUDGED_RUN_S: f64 = 2.0 * MEMORY_SETTLING_S;
/// Shortest time of a goal and the return, s. Source: ours.
const SHORTEST_TASK: f64 = 10.0;

/// A figure and its limit.
pub struct Limit {
    /// The figure's name.
    pub name: &'static str,
    /// The figure; `None` if it could not be measured.
    pub value: Option<f64>,
    /// The limit.
    pub max: f64,
    /// The unit of both.
    pub unit: &'static str,
}

impl Limit {
    /// Whether the figure meets its limit; false for an unmeasured figure.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        self.value.is_some_and(|value| value <= self.max)
    }

    fn row(&self) -> Vec<String> {
        let value = self.value.map_or_else(|| "not measured".to_owned(), |v| format!("{v:.2} {}", self.unit));
        let kept = if self.is_kept() { "yes" } else { "NO" };
        vec![self.name.to_owned(), value, format!("{} {}", self.max, self.unit), kept.to_owned()]
    }
}

/// The request of a run in real time.
#[derive(Debug, Clone)]
pub struct RealTimeRequest {
    /// Duration of the run \[min\].
    pub minutes: u32,
    /// Seed of noise and scene.
    pub seed: u64,
    /// The robot.
    pub robot: RobotConfig,
}

/// The outcome of a run in real time.
pub struct RealTimeOutcome {
    /// The figures with their limits.
    pub limits: Vec<Limit>,
    /// Timing of the run.
    pub timing: RealTimeReport,
    /// Number of goals reached.
    pub goals: usize,
    /// Number of contacts.
    pub contacts: usize,
    /// Number of images dropped.
    pub images_dropped: usize,
    /// Whether an exploration was incomplete.
    pub is_unexplored: bool,
    /// Wall-clock time of the run \[s\].
    pub seconds: f64,
}

/// Drives to and fro in the demo's scene, and records into `folder`. A run that measures memory explores the scene first, since the map
/// would grow later: two equally long paths lead past its obstacles.
///
/// # Errors
/// When the system refuses a thread, or the robot is invalid.
pub fn run(
    request: &RealTimeRequest,
    folder: &OutputFolder,
    context: &ExperimentContext,
) -> Result<RealTimeOutcome, AppError> {
    let robot = request.robot.clone().with_seed(request.seed);
    let scene = Scene::by_name("demo", request.seed)?;
    let seconds = 60.0 * f64::from(request.minutes);
    let before = if seconds >= MIN_JUDGED_RUN_S { vec![Task::Explore] } else { vec![] };
    let pair = [Task::go(scene.start_from_goal()), Task::Return];
    let mission = Mission::new([before, pair.repeat((seconds / SHORTEST_TASK) as usize)].concat())?;
    let mut setup = RunSetup::new(&scene.name, mission, robot).with_time_limit(seconds);
    setup.seed = request.seed;
    setup.map_from_world = scene.start.inverse();
    setup.real_time = true;
    let config = simulated_real_time_body(&setup.robot, FaultSchedule::default())?;
    let body = Simulator::new(scene, config, request.seed).map_err(AppError::input)?;
    context.display.begin(1, "runs");
    let staged = context.display.enter(format!("{} min, seed {}", request.minutes, request.seed));
    let front_end = staged.front_end(context.display.progress().clone());
    let start = |events, place| SimulatedRealTimeBody::start(body, events, place);
    let (run, timing) = run_in_real_time(&setup, start, folder, None, RunLog::brief(), front_end)?;
    Ok(RealTimeOutcome::of(&run, timing))
}

/// Limits of the evaluation, with the growth of memory only for long enough runs.
fn limits(timing: &RealTimeReport) -> Vec<Limit> {
    let end = timing.memory.samples.last().map_or(0.0, |(time, _)| *time);
    let growth = Limit {
        name: "growth of memory",
        value: timing.memory.growth_mb_an_hour(MEMORY_SETTLING_S),
        max: MAX_MEMORY_GROWTH_MB_PER_H,
        unit: "MB/h",
    };
    let all = [
        Limit {
            name: "control jitter, p99.9",
            value: timing.control.as_ref().map(|control| control.jitter_p999_ms),
            max: JITTER_MS,
            unit: "ms",
        },
        Limit {
            name: "load of the robot's core",
            value: Some(timing.load_total * 100.0),
            max: MAX_CPU_LOAD * 100.0,
            unit: "%",
        },
    ];
    all.into_iter().chain((end >= MIN_JUDGED_RUN_S).then_some(growth)).collect()
}

impl RealTimeOutcome {
    fn of(run: &FinishedRun, timing: RealTimeReport) -> Self {
        let tasks = run.robot.tasks_ended();
        let is_reached = |record: &&TaskRecord| record.task != Task::Explore && record.end == TaskEnd::Done;
        let is_left = |record: &TaskRecord| record.task == Task::Explore && record.end != TaskEnd::Done;
        Self {
            limits: limits(&timing),
            timing,
            goals: tasks.iter().filter(is_reached).count(),
            contacts: run.log.contacts(),
            images_dropped: run.robot.dropped_images().len(),
            is_unexplored: tasks.iter().any(is_left),
            seconds: run.seconds,
        }
    }

    fn limit_table(&self) -> Table {
        self.limits.iter().map(Limit::row).fold(Table::new("Limits", HEADER), Table::row)
    }
}

impl ExperimentReport for RealTimeOutcome {
    fn is_success(&self) -> bool {
        let driven = self.contacts == 0 && self.goals > 0 && !self.is_unexplored && !self.timing.interrupted;
        driven && self.limits.iter().all(Limit::is_kept)
    }

    fn table(&self) -> Vec<Vec<String>> {
        std::iter::once(HEADER.map(str::to_owned).to_vec())
            .chain(self.limits.iter().map(Limit::row))
            .collect()
    }

    fn verdict(&self) -> String {
        let kept = self.limits.iter().filter(|limit| limit.is_kept()).count();
        format!(
            "{kept} of {} limits kept over {:.1} min; {} goals, {} contacts, {} of {} images dropped{}.",
            self.limits.len(),
            self.seconds / 60.0,
            self.goals,
            self.contacts,
            self.images_dropped,
            self.timing.body.images,
            if self.is_unexplored { "; the room could not be explored" } else { "" }
        )
    }

    fn write(&self, folder: &OutputFolder) -> Result<(), AppError> {
        let (timing, text) = (&self.timing, self.verdict());
        let verdict = if self.is_success() { Verdict::Ok(text) } else { Verdict::Failed(text) };
        let rows = timing.rows().into_iter().fold(Table::new("Figures", ["what", "figure"]), Table::row);
        let chart = Chart::new("Checkpoint", "time, s", "MB").line(
            "resident, robot and simulator",
            Color::BLUE,
            timing.memory.samples.clone(),
        );
        let report = Report::new("Real time")
            .subtitle("To and fro in the demo's room (explored first, if memory is measured): control at 50 Hz, camera at 30 Hz, the robot on a core of its own.")
            .verdict(verdict)
            .table(self.limit_table())
            .figure(Figure::chart(&chart))
            .table(rows.wide());
        folder.write("report.html", report.to_html().as_bytes())?;
        folder.write("memory.csv", minutes(timing).as_bytes())?;
        let mut summary = Summary::new("experiment real-time");
        summary
            .set("success", self.is_success())
            .set("contacts", self.contacts)
            .set("images_dropped", self.images_dropped)
            .set("wall_clock", serde_json::json!({ "total_s": self.seconds, "real_time": timing }));
        folder.write("summary.json", summary.to_json().as_bytes())?;
        Ok(())
    }
}

const HEADER: [&str; 4] = ["what", "measured", "at most", "kept"];

/// Resident memory at each minute.
fn minutes(timing: &RealTimeReport) -> String {
    let mut next = 0.0;
    let samples = timing.memory.samples.iter().filter(|(time, _)| {
        let is_due = *time >= next;
        if is_due {
            next += 60.0;
        }
        is_due
    });
    table_csv(["time_s", "resident_mb"], samples.map(|(time, mb)| [*time, *mb]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_kept_up_to_its_value_and_never_without_a_measurement() {
        let limit = |value| Limit { name: "load", value, max: 60.0, unit: "%" };
        assert!(limit(Some(60.0)).is_kept() && !limit(Some(60.1)).is_kept() && !limit(None).is_kept());
        assert_eq!(limit(Some(12.345)).row(), ["load", "12.35 %", "60 %", "yes"]);
        assert_eq!(limit(None).row(), ["load", "not measured", "60 %", "NO"]);
    }
}
