//! By the clock on the wall for many minutes: how evenly the robot is steered, what it costs of a core, and whether memory stays flat.

use super::RealTimeArgs;
use crate::run::{Run, RunSetup};
use crate::{
    Outcome, console, demo, failure::Failure, logbook::Logbook, real_time, real_time::Timing, robot_file,
};
use trundle::io::{OutputFolder, Summary, table_csv};
use trundle::runtime::{Mission, Task, TaskEnd, TaskRecord};
use trundle::sim::{FaultSchedule, Scene, Simulator};
use trundle::viz::{Chart, Color, Figure, Report, Table, Verdict};

/// 999 of 1000 commands come within this of their time, ms.
const JITTER_MS: f64 = 5.0;
/// Of the robot's core, all its threads together.
const LOAD: f64 = 0.6;
/// Robot and simulator may grow by so much once maps and buffers have their size, MB an hour.
const GROWTH: f64 = 10.0;
/// Before this, s, memory may grow: the rooms are not yet known.
const SETTLED: f64 = 600.0;
/// Runs shorter than this, s, do not tell how it grows.
const JUDGED: f64 = 2.0 * SETTLED;
/// A goal and the way back take at least so long, s.
const SHORTEST_TASK: f64 = 10.0;

/// One limit of the issue.
struct Limit {
    what: &'static str,
    value: Option<f64>,
    most: f64,
    unit: &'static str,
}

impl Limit {
    /// What could not be measured is not kept.
    fn is_kept(&self) -> bool {
        self.value.is_some_and(|value| value <= self.most)
    }

    fn row(&self) -> Vec<String> {
        let value = self.value.map_or_else(|| "not measured".to_owned(), |v| format!("{v:.2} {}", self.unit));
        let kept = if self.is_kept() { "yes" } else { "NO" };
        vec![self.what.to_owned(), value, format!("{} {}", self.most, self.unit), kept.to_owned()]
    }
}

/// Drives to and fro in the demo's room for so many minutes; where memory is judged, too, once the room is explored. (Two ways lead past what
/// stands in it, equally long: a robot that had seen but one would map the other when it first takes that, any time.)
pub fn run(args: &RealTimeArgs) -> Result<Outcome, Failure> {
    let robot = robot_file::load(args.config.as_deref())?.with_seed(args.seed);
    let scene = Scene::by_name("demo", args.seed)?;
    let seconds = 60.0 * f64::from(args.minutes);
    let before = if seconds >= JUDGED { vec![Task::Explore] } else { vec![] };
    let pair = [Task::Go(scene.start_from_goal()), Task::Return];
    let setup = RunSetup {
        scene: scene.name.clone(),
        seed: args.seed,
        map_from_world: scene.start.inverse(),
        time_limit: seconds,
        mission: Mission::new([before, pair.repeat((seconds / SHORTEST_TASK) as usize)].concat())?,
        robot,
        real_time: true,
        woken: None,
    };
    let mut config = demo::simulated(&setup.robot, FaultSchedule::default())?;
    config.camera_rate_hz = real_time::CAMERA_HZ;
    config.kobuki.command_timeout = real_time::COMMAND_TIMEOUT;
    let body = Simulator::new(scene, config, args.seed)?;
    let folder = OutputFolder::create(&args.out)?;
    let (run, timing) =
        real_time::drive_live(&setup, body, &folder, None, Logbook::brief(), args.common.quiet)?;
    finish(args, &run, &timing, folder)
}

/// What is judged; the growth of memory only where the run goes on for long enough after the rooms are known.
fn limits(timing: &Timing) -> Vec<Limit> {
    let end = timing.memory.samples.last().map_or(0.0, |(time, _)| *time);
    let growth = Limit {
        what: "growth of memory",
        value: timing.memory.growth_mb_an_hour(SETTLED),
        most: GROWTH,
        unit: "MB/h",
    };
    let all = [
        Limit {
            what: "control jitter, p99.9",
            value: timing.control.as_ref().map(|control| control.jitter_p999_ms),
            most: JITTER_MS,
            unit: "ms",
        },
        Limit {
            what: "load of the robot's core",
            value: Some(timing.load_total * 100.0),
            most: LOAD * 100.0,
            unit: "%",
        },
    ];
    all.into_iter().chain((end >= JUDGED).then_some(growth)).collect()
}

fn finish(args: &RealTimeArgs, run: &Run, timing: &Timing, folder: OutputFolder) -> Result<Outcome, Failure> {
    let limits = limits(timing);
    let contacts = run.log.contacts();
    let is_reached = |record: &&TaskRecord| record.task != Task::Explore && record.end == TaskEnd::Done;
    let done = run.robot.tasks_ended().iter().filter(is_reached).count();
    let is_left = |record: &TaskRecord| record.task == Task::Explore && record.end != TaskEnd::Done;
    let unexplored = run.robot.tasks_ended().iter().any(is_left);
    let driven = contacts == 0 && done > 0 && !unexplored && !timing.interrupted;
    let success = driven && limits.iter().all(Limit::is_kept);
    let kept = limits.iter().filter(|limit| limit.is_kept()).count();
    let dropped = run.robot.dropped_images().len();
    let told = format!(
        "{kept} of {} limits kept over {:.1} min; {done} goals, {contacts} contacts, {dropped} of {} images dropped{}.",
        limits.len(),
        run.seconds / 60.0,
        timing.world.images,
        if unexplored { "; the room could not be explored" } else { "" }
    );
    let verdict = if success { Verdict::Ok(told.clone()) } else { Verdict::Failed(told.clone()) };
    let table = limits.iter().map(Limit::row).fold(Table::new("Limits", HEADER), Table::row);
    let rows = timing.rows().into_iter().fold(Table::new("Figures", ["what", "figure"]), Table::row);
    let chart = Chart::new("Memory", "time, s", "MB").line(
        "resident, robot and simulator",
        Color::BLUE,
        timing.memory.samples.clone(),
    );
    let report = Report::new("By the clock on the wall")
        .subtitle("To and fro in the demo's room (explored before, where memory is judged): control at 50 Hz, camera at 30 Hz, the robot on a core of its own.")
        .verdict(verdict)
        .table(table)
        .figure(Figure::chart(&chart))
        .table(rows.wide());
    folder.write("report.html", report.to_html().as_bytes())?;
    folder.write("memory.csv", minutes(timing).as_bytes())?;
    let mut summary = Summary::new("experiment real-time");
    summary.set("success", success).set("contacts", contacts).set("images_dropped", dropped);
    summary.set("wall_clock", serde_json::json!({ "total_s": run.seconds, "real_time": timing }));
    folder.write("summary.json", summary.to_json().as_bytes())?;
    let place = folder.commit()?;
    if !args.common.quiet {
        let header = HEADER.map(str::to_owned).to_vec();
        console::table(&std::iter::once(header).chain(limits.iter().map(Limit::row)).collect::<Vec<_>>());
        console::table(&timing.rows());
        console::say(&format!("\n{told}\nSee {}", place.join("report.html").display()));
    }
    Ok(if success { Outcome::Reached } else { Outcome::Missed })
}

const HEADER: [&str; 4] = ["what", "measured", "at most", "kept"];

/// Resident memory at each minute.
fn minutes(timing: &Timing) -> String {
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
