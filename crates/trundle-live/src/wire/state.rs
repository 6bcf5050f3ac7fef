//! The state of the robot as JSON.

use crate::processor_time::{clock_s, processor_time_s};
use serde::Serialize;
use trundle_app::operator::RunView;
use trundle_planning::MovingObstacle;
use trundle_runtime::Task;

/// The state of the robot, sent up to ten times per second.
#[derive(Debug, Clone, Serialize)]
#[serde(tag = "type", rename = "state")]
pub struct StateMessage {
    /// Number of this view; the page gives it back.
    pub batch: u64,
    /// Time of the robot \[s\].
    pub time: f64,
    /// Pose and speed.
    #[serde(flatten)]
    pub motion: MotionText,
    /// Activity of the robot.
    #[serde(flatten)]
    pub activity: ActivityText,
    /// The battery.
    #[serde(flatten)]
    pub power: PowerText,
    /// Dynamic obstacles: x, y \[m\], radius \[m\], x and y in [`FORECAST_S`] \[m\].
    pub movers: Vec<[f64; 5]>,
    /// The charging station: x \[m\], y \[m\], heading out of its front \[rad\].
    pub station: Option<[f64; 3]>,
    /// Runs of SLAM, mapping and control so far, and dropped images.
    pub counts: [u64; 4],
    /// The stages of the robot with the time of each by the clock so far \[s\].
    pub stages: Vec<(&'static str, f64)>,
    /// Processor time of the program, and time by its clock \[s\]; `None` if the system does not report it.
    pub processor: Option<[f64; 2]>,
    /// Closed loops: time \[s\], and position of the robot \[m\].
    pub loops: Vec<[f64; 3]>,
    /// The viewer in control; `None` without one.
    pub wheel: Option<WheelText>,
    /// Number of viewers.
    pub viewers: usize,
}

/// Pose and speed of the robot.
#[derive(Debug, Clone, Serialize)]
pub struct MotionText {
    /// `map_from_base`: x \[m\], y \[m\], heading \[rad\].
    pub pose: [f64; 3],
    /// Covariance of the position in the map frame, xx, xy, yy \[m^2\], and variance of the heading \[rad^2\].
    pub covariance: [f64; 4],
    /// Measured speed \[m/s\] and turn rate \[rad/s\].
    pub twist: [f64; 2],
    /// Commanded speed \[m/s\] and turn rate \[rad/s\].
    pub command: [f64; 2],
}

/// Activity of the robot.
#[derive(Debug, Clone, Serialize)]
pub struct ActivityText {
    /// The state in one or two words.
    pub state: &'static str,
    /// Reason why the robot does not move.
    pub reason: Option<String>,
    /// The condition under which no wheel may turn.
    pub hold: Option<String>,
    /// Whether a person paused the robot.
    pub paused: bool,
    /// The tasks that have not ended, the present one first.
    pub left: Vec<TaskText>,
    /// The last tasks that have ended, with their ends.
    pub ended: Vec<String>,
    /// Whether all tasks have ended.
    pub over: bool,
}

/// The battery of the robot.
#[derive(Debug, Clone, Serialize)]
pub struct PowerText {
    /// Charge, 0 to 1.
    pub charge: Option<f64>,
    /// Voltage \[V\].
    pub voltage: Option<f64>,
    /// Whether the battery is being charged.
    pub charging: bool,
}

/// The viewer who drives.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WheelText {
    /// Name of the viewer.
    pub name: String,
    /// Whether the reader of this message is in control.
    pub is_you: bool,
}

/// A task in words, and its goal.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskText {
    /// The task in words.
    pub text: String,
    /// Goal of the task: x \[m\], y \[m\], heading \[rad\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<[f64; 3]>,
}

/// Time of the forecast of dynamic obstacles that is shown \[s\]. Source: ours; the planner's horizon is longer.
const FORECAST_S: f64 = 1.0;
/// Number of ended tasks that are sent. Source: ours.
const SHOWN_ENDED_TASKS: usize = 5;

impl StateMessage {
    /// The state of a view.
    pub fn of(view: &RunView, batch: u64, wheel: Option<WheelText>, viewers: usize) -> Self {
        let (around, counts) = (&view.perception, &view.counts);
        Self {
            batch,
            time: view.stamp.as_secs(),
            motion: MotionText::of(view),
            activity: ActivityText::of(view),
            power: PowerText {
                charge: view.battery.and_then(|battery| battery.charge),
                voltage: view.battery.map(|battery| battery.voltage_v),
                charging: view.battery.is_some_and(|battery| battery.is_charging),
            },
            movers: around.movers.iter().map(mover_text).collect(),
            station: around.station.map(|station| [station.x, station.y, station.theta]),
            counts: [counts.slam, counts.mapping, counts.control, counts.dropped_images],
            stages: counts.stages.clone(),
            processor: processor_time_s().map(|work| [work, clock_s()]),
            loops: around.loops.iter().map(|at| [at.stamp.as_secs(), at.pose.x, at.pose.y]).collect(),
            wheel,
            viewers,
        }
    }
}

impl MotionText {
    fn of(view: &RunView) -> Self {
        let estimate = &view.estimate;
        Self {
            pose: [estimate.pose.x, estimate.pose.y, estimate.pose.theta],
            covariance: map_covariance(view),
            twist: [estimate.twist.v, estimate.twist.omega],
            command: [view.twist.v, view.twist.omega],
        }
    }
}

impl ActivityText {
    fn of(view: &RunView) -> Self {
        let ended = &view.mission.ended;
        let shown = ended.len().saturating_sub(SHOWN_ENDED_TASKS);
        Self {
            state: view.state.name(),
            reason: view.state.reason(),
            hold: view.hold.map(|hold| hold.to_string()),
            paused: view.hold == Some(trundle_runtime::MotionHold::Paused),
            left: view.mission.left.iter().map(TaskText::of).collect(),
            ended: ended[shown..].iter().map(|record| format!("{}: {}", record.task, record.end)).collect(),
            over: view.mission.is_over,
        }
    }
}

impl TaskText {
    fn of(task: &Task) -> Self {
        let goal = trundle_app::RunSetup::goal_of(task).map(|goal| [goal.x, goal.y, goal.theta]);
        Self { text: task.to_string(), goal }
    }
}

fn mover_text(mover: &MovingObstacle) -> [f64; 5] {
    let (now, later) = (mover.at(0.0), mover.at(FORECAST_S));
    [now.x, now.y, mover.radius(), later.x, later.y]
}

/// Variances and covariance of the position in the map frame, and the variance of the heading.
fn map_covariance(view: &RunView) -> [f64; 4] {
    let c = view.map_covariance();
    [c[0][0], c[0][1], c[1][1], c[2][2]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};
    use trundle_app::operator::{Activity, ClosedLoop, PerceptionView, RunCounts};
    use trundle_core::{Battery, Pose2, PowerSource, Stamp, Twist2, Vector2};

    fn message(change: impl FnOnce(&mut RunView)) -> Value {
        let activity = Activity { name: "standing", reason: None };
        let mut view = RunView::of_activity(Stamp::default(), Pose2::default(), Twist2::ZERO, activity);
        change(&mut view);
        serde_json::to_value(StateMessage::of(&view, 7, None, 2)).unwrap()
    }

    #[test]
    fn people_loops_station_battery_and_dropped_images_reach_the_page() {
        let person = MovingObstacle::new(Vector2::new(1.0, 2.0), Vector2::new(0.5, -1.0), 0.3).unwrap();
        let state = message(|view| {
            view.perception = PerceptionView {
                movers: vec![person],
                loops: vec![ClosedLoop {
                    stamp: Stamp::default().after(3.0),
                    pose: Pose2::new(4.0, 5.0, 0.1),
                }],
                station: Some(Pose2::new(-1.0, 0.0, 0.5)),
                ..PerceptionView::default()
            };
            view.counts = RunCounts { slam: 1, mapping: 2, control: 3, dropped_images: 4, stages: vec![] };
            let source = PowerSource::default();
            view.battery = Some(Battery { voltage_v: 14.5, charge: Some(0.25), source, is_charging: true });
        });
        assert_eq!(
            state["movers"],
            json!([[1.0, 2.0, 0.3, 1.5, 1.0]]),
            "the last two are its forecast for 1 s"
        );
        assert_eq!(state["loops"], json!([[3.0, 4.0, 5.0]]));
        assert_eq!(state["station"], json!([-1.0, 0.0, 0.5]));
        assert_eq!(state["counts"], json!([1, 2, 3, 4]));
        assert_eq!((&state["charge"], &state["voltage"]), (&json!(0.25), &json!(14.5)));
        assert_eq!(
            (&state["charging"], &state["batch"], &state["viewers"]),
            (&json!(true), &json!(7), &json!(2))
        );
        let plain = message(|_| {});
        assert_eq!(
            (&plain["movers"], &plain["station"], &plain["charge"]),
            (&json!([]), &Value::Null, &Value::Null)
        );
    }
}
