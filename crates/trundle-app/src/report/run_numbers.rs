//! The figures of a run, and their table and summary.

use super::goal_outcome::allowed;
use super::{GoalOutcome, SensorsRun};
use crate::real_time::RealTimeReport;
use crate::{FinishedRun, RunSetup, TrackCounts};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use trundle_core::PoseBound;
use trundle_eval::{GoalError, goal_error};
use trundle_io::Summary;
use trundle_runtime::{DriveState, GoalApproachReport, Reason, Stage, StageTimes, TaskEnd};

/// The numbers of a run, without the wall clock's.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RunNumbers {
    /// Outcomes of the mission's goals, in order.
    pub goals: Vec<GoalOutcome>,
    /// Number of goals in the mission; `None` for a mission that only stays at the start.
    pub goals_asked: Option<usize>,
    /// Error of the robot's true pose at the end, against the last goal; `None` without truth.
    pub goal_error: Option<GoalError>,
    /// Error of the estimated pose against the last goal.
    pub believed_error: Option<GoalError>,
    /// The estimate's distance from truth over the run: root of the mean square, m.
    pub estimate_rmse: Option<f64>,
    /// Number of contacts: the true number if known.
    pub contacts: usize,
    /// Distance driven, m.
    pub path_length: f64,
    /// Time of the robot, s.
    pub duration: f64,
    /// Plans made.
    pub plans: usize,
    /// Images by tracking state.
    pub tracked: TrackCounts,
    /// Landmarks and keyframes in the visual map.
    pub landmarks: usize,
    /// Keyframes in the visual map.
    pub keyframes: usize,
    /// Stamps of the images that a newer one replaced before they were processed, s since the start.
    pub images_dropped: Vec<f64>,
    /// Report of turns and straight moves for the last goal with such a request; `None` without a request.
    /// Files of numbers do not contain it.
    #[serde(skip)]
    pub docking: Option<GoalApproachReport>,
    /// End of the run.
    pub end: RunEnd,
}

/// The end of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunEnd {
    /// The robot's state.
    pub state: DriveState,
    /// Whether an operator gave the missions: the end of the run is then no failure.
    pub is_operated: bool,
    /// The result of a run that had only the sensors of a robot that something else drove, and no mission.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of_sensors: Option<SensorsRun>,
    /// The time limit that ended the run \[s\], if one did.
    pub out_of_time: Option<f64>,
    /// Numbers of tasks at the end, with and without a goal.
    pub tasks: TaskCounts,
    /// The errors that the last goal of the mission allows.
    #[serde(default = "GoalOutcome::exact")]
    pub allowed: PoseBound,
}

/// Numbers of tasks at the end of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TaskCounts {
    /// Number of tasks reported as done.
    pub done: usize,
    /// Number of tasks left.
    pub left: usize,
}

impl RunEnd {
    fn of(setup: &RunSetup, run: &FinishedRun) -> Self {
        let log = &run.log;
        let tasks = TaskCounts {
            done: run.tasks().filter(|record| record.end == TaskEnd::Done).count(),
            left: run.robot.tasks_left().map_or(0, |left| left.len()),
        };
        Self {
            tasks,
            state: log.state.clone(),
            is_operated: setup.is_operated,
            of_sensors: setup.is_of_sensors().then(|| SensorsRun::of(run)),
            out_of_time: setup.is_out_of_time(log).then_some(setup.time_limit),
            allowed: setup
                .last_goal_task()
                .map_or_else(GoalOutcome::exact, |task| allowed(&task, &setup.robot)),
        }
    }

    /// Whether the run ended before its mission.
    fn is_cut(&self) -> bool {
        self.out_of_time.is_some() || self.state == DriveState::Stopped { reason: Reason::Interrupted }
    }

    fn why_not_arrived(&self) -> String {
        match self.out_of_time {
            Some(limit) => format!("the time limit of {limit} s ended the run ({})", self.state),
            None => format!("the robot did not arrive ({})", self.state),
        }
    }
}

fn docking_text(docking: &GoalApproachReport) -> String {
    let GoalApproachReport { plans, motions, restarts, waits, time, ended, .. } = docking;
    let end = ended.as_ref().map_or_else(|| "unused".to_owned(), ToString::to_string);
    format!("{motions} motions, {plans} plans, {restarts} broken off, {waits} waits, {time:.1} s; {end}")
}

impl RunNumbers {
    /// The numbers of a run that has ended.
    pub fn of(setup: &RunSetup, run: &FinishedRun) -> Self {
        let log = &run.log;
        let against_goal = |pose| goal_error(setup.last_goal()?, pose).ok();
        Self {
            goals: GoalOutcome::all(run, &setup.robot),
            goals_asked: (!setup.is_without_motion())
                .then(|| setup.mission.tasks().iter().filter_map(RunSetup::goal_of).count()),
            goal_error: log.truths.last().and_then(|(_, truth)| against_goal(*truth)),
            believed_error: against_goal(run.robot.estimate().pose),
            estimate_rmse: log.estimate_rmse(),
            contacts: log.contacts(),
            path_length: log.path_length(),
            duration: log.elapsed(),
            plans: log.plans,
            tracked: log.tracked,
            landmarks: run.robot.slam().map_or(0, |slam| slam.landmarks().count()),
            keyframes: run.robot.slam().map_or(0, |slam| slam.keyframes().count()),
            images_dropped: log.seconds_of(run.robot.dropped_images()),
            docking: run.robot.docking().filter(|docking| docking.plans > 0).cloned(),
            end: RunEnd::of(setup, run),
        }
    }

    /// The error against the last goal, by which the run succeeds or fails: in truth if it is known, else of the estimate.
    fn judged_error(&self) -> Option<GoalError> {
        self.goal_error.or(self.believed_error)
    }

    /// Whether the end is near enough to the last goal; true without a goal.
    pub fn is_near(&self) -> bool {
        self.judged_error().is_none_or(|error| error.distance < self.end.allowed.distance)
    }

    /// Whether the heading is near enough to the last goal's; true without a goal.
    pub fn is_aligned(&self) -> bool {
        self.judged_error().is_none_or(|error| error.dtheta.abs() < self.end.allowed.heading)
    }

    /// Whether every goal was reached without a contact, in truth if it is known.
    pub fn is_success(&self) -> bool {
        if let Some(sensors) = self.end.of_sensors {
            return !self.end.is_cut() && sensors.failure(self.duration).is_none();
        }
        if self.end.is_operated {
            let is_done = self.end.tasks.done > 0 && self.end.tasks.left == 0;
            return is_done && self.goals_missed() == 0 && self.contacts == 0;
        }
        let all = self.goals_missed() == 0 && self.goals_asked.is_some();
        self.end.state == DriveState::Arrived
            && all
            && self.is_near()
            && self.is_aligned()
            && self.contacts == 0
    }

    /// Goals that the robot reported as reached and missed in truth.
    fn goals_missed(&self) -> usize {
        let believed = self.goals.iter().filter(|goal| goal.end == TaskEnd::Done);
        believed.filter(|goal| !goal.is_reached()).count()
    }

    /// Result of the run, in one sentence.
    pub fn verdict(&self) -> String {
        if let Some(sensors) = self.end.of_sensors {
            return self.sensors_verdict(sensors);
        }
        if self.is_success() {
            return match self.goals.iter().filter(|goal| goal.end == TaskEnd::Done).count() {
                0 => "Mission done, nothing touched.".to_owned(),
                1 => "Goal reached, nothing touched.".to_owned(),
                n => format!("All {n} goals reached, nothing touched."),
            };
        }
        if self.end.is_operated {
            return self.operated_verdict();
        }
        let mut faults = Vec::new();
        if self.goals_asked.is_none() {
            faults.push("the goal is the start, so the robot had nothing to do".to_owned());
        }
        if self.end.state != DriveState::Arrived {
            faults.push(self.end.why_not_arrived());
        }
        // A run that was ended early has not reached its last goal.
        let is_off = !(self.end.is_cut() || self.is_near() && self.is_aligned());
        if let Some(error) = self.judged_error().filter(|_| is_off) {
            let (cm, deg) = (error.distance * 100.0, error.dtheta.to_degrees());
            faults.push(format!("it stands {cm:.1} cm and {deg:.1} deg off the goal"));
        }
        if self.goals_missed() > 0 && self.is_near() && self.is_aligned() {
            faults.push(format!("at {} goals it stood too far off", self.goals_missed()));
        }
        if self.contacts > 0 {
            faults.push(format!("{} contacts with obstacles", self.contacts));
        }
        format!("Failed: {}.", faults.join("; "))
    }

    /// The verdict of a run on the sensors of a robot that something else drove.
    fn sensors_verdict(&self, sensors: SensorsRun) -> String {
        match sensors.failure(self.duration) {
            _ if self.end.is_cut() => "Failed: the run was ended early.".to_owned(),
            Some(failure) => format!("Failed: {failure}."),
            None => "Replayed: the robot had no mission; it located itself and mapped.".to_owned(),
        }
    }

    /// The verdict of a run that the operator ended.
    fn operated_verdict(&self) -> String {
        let mut faults = Vec::new();
        if self.end.tasks.left > 0 {
            faults.push(format!(
                "{} tasks were open at the end, {} done",
                self.end.tasks.left, self.end.tasks.done
            ));
        } else if self.end.tasks.done == 0 {
            faults.push("no task was done".to_owned());
        }
        if self.goals_missed() > 0 {
            faults.push(format!("{} goals were missed in truth", self.goals_missed()));
        }
        if self.contacts > 0 {
            faults.push(format!("{} contacts with obstacles", self.contacts));
        }
        format!("Failed: {}.", faults.join("; "))
    }

    /// The table without the wall clock's part.
    pub fn run_rows(&self) -> Vec<Vec<String>> {
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        let error = |e: &GoalError| format!("{:.1} cm, {:.2} deg", e.distance * 100.0, e.dtheta.to_degrees());
        let mut rows = Vec::new();
        if self.goals.len() > 1 {
            rows.extend(self.goals.iter().map(GoalOutcome::row));
        }
        rows.extend(self.goal_error.as_ref().map(|e| row("goal error against truth", error(e))));
        rows.extend(self.believed_error.as_ref().map(|e| row("goal error of the estimate", error(e))));
        rows.extend(
            self.estimate_rmse.map(|e| row("estimate against truth, rmse", format!("{:.1} cm", e * 100.0))),
        );
        rows.push(row("path length", format!("{:.2} m", self.path_length)));
        rows.push(row("contacts", self.contacts.to_string()));
        rows.push(row("time", format!("{:.1} s", self.duration)));
        rows.push(row("plans", self.plans.to_string()));
        let TrackCounts { ok, weak, dead_reckoned, lost } = self.tracked;
        rows.push(row(
            "images ok / weak / dead reckoned / lost",
            format!("{ok} / {weak} / {dead_reckoned} / {lost}"),
        ));
        rows.extend(
            self.docking.as_ref().map(|docking| row("turns and straight moves", docking_text(docking))),
        );
        rows.push(row("images dropped", self.images_dropped.len().to_string()));
        rows.push(row("keyframes, landmarks", format!("{}, {}", self.keyframes, self.landmarks)));
        rows
    }

    /// The whole table for the terminal.
    pub fn rows(&self, run: &FinishedRun) -> Vec<Vec<String>> {
        let mut rows = self.run_rows();
        rows.extend(run.log.body.rows());
        rows.push(vec!["wall clock".to_owned(), format!("{:.1} s", run.seconds)]);
        rows.push(["stage, ms", "median", "p99", "p99.9", "max", "runs"].map(str::to_owned).to_vec());
        rows.extend(stage_rows(run.robot.times()));
        rows
    }

    /// `summary.json`: the numbers of the table; the wall clock's under `wall_clock`.
    pub fn summary(&self, setup: &RunSetup, run: &FinishedRun, timing: Option<&RealTimeReport>) -> Summary {
        // A replay's summary equals the run's byte for byte, so it has the run's command.
        let mut summary = Summary::new(&setup.command);
        summary
            .set("scene", &setup.scene)
            .set("seed", setup.seed)
            .set("success", self.is_success())
            .set("cut", &run.cut)
            .set("state", self.end.state.to_string())
            .set("reason_kinds", self.end.state.reason().map(Reason::kinds).unwrap_or_default())
            .set("out_of_time_s", self.end.out_of_time)
            .set("goals", &self.goals)
            .set("goal_error_m", self.goal_error.map(|e| e.distance))
            .set("goal_error_dx_m", self.goal_error.map(|e| e.dx))
            .set("goal_error_dy_m", self.goal_error.map(|e| e.dy))
            .set("goal_error_heading_rad", self.goal_error.map(|e| e.dtheta))
            .set("believed_error_m", self.believed_error.map(|e| e.distance))
            .set("believed_error_heading_rad", self.believed_error.map(|e| e.dtheta))
            .set("estimate_rmse_m", self.estimate_rmse)
            .set("pose_lost_s", run.log.pose_lost_s)
            .set("path_length_m", self.path_length)
            .set("contacts", self.contacts)
            .set("duration_s", self.duration)
            .set("plans", self.plans)
            .set("images_ok", self.tracked.ok)
            .set("images_weak", self.tracked.weak)
            .set("images_dead_reckoned", self.tracked.dead_reckoned)
            .set("images_lost", self.tracked.lost)
            .set("keyframes", self.keyframes)
            .set("landmarks", self.landmarks)
            .set("docking", &self.docking)
            .set("images_dropped", self.images_dropped.len())
            .set("images_dropped_at_s", &self.images_dropped)
            .set("wall_clock", wall_clock(run.seconds, run.robot.times(), timing));
        run.log.body.add_to(&mut summary);
        summary.set_interrupted(run.log.is_interrupted());
        summary
    }
}

/// Times of the wall clock: the only part of any output that differs between two equal runs.
pub fn wall_clock(seconds: f64, times: &StageTimes, timing: Option<&RealTimeReport>) -> Value {
    let mut stages = Map::new();
    for stage in Stage::ALL {
        if let Some(cost) = times.cost(stage) {
            stages.insert(stage.name().to_owned(), json!(cost));
        }
    }
    let mut all = json!({ "total_s": seconds, "stages": stages });
    if let Some(timing) = timing {
        all["real_time"] = json!(timing);
    }
    all
}

/// A row a stage: name, median, 99th percentile, runs.
pub fn stage_rows(times: &StageTimes) -> Vec<Vec<String>> {
    let costs = Stage::ALL.into_iter().filter_map(|stage| Some((stage, times.cost(stage)?)));
    costs
        .map(|(stage, cost)| {
            let numbers =
                [cost.median_ms, cost.p99_ms, cost.p999_ms, cost.max_ms].map(|ms| format!("{ms:.3}"));
            let runs = cost.runs.to_string();
            std::iter::once(stage.name().to_owned()).chain(numbers).chain([runs]).collect()
        })
        .collect()
}
