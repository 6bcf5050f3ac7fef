//! Missions as TOML files.

use crate::{AppError, read_toml};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::{Pose2, number_list};
use trundle_io::read_places;
use trundle_runtime::{GoalOptions, Mission, Task, TaskGoal, WhenBlocked};

/// The form of a mission file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MissionFile {
    /// File of named places, relative to the mission file.
    places: Option<String>,
    task: Vec<TaskEntry>,
}

/// A task: exactly one key names its kind; the others are settings of a goal.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TaskEntry {
    /// Goal pose, map frame: m, m, deg.
    #[serde(default, deserialize_with = "number_list")]
    go: Option<[f64; 3]>,
    /// Turn on the spot, positive to the left \[deg\].
    turn_deg: Option<f64>,
    /// Straight drive, back if it is negative \[m\].
    straight_m: Option<f64>,
    /// Name of a place.
    place: Option<String>,
    #[serde(default)]
    explore: bool,
    #[serde(default, rename = "return")]
    back: bool,
    #[serde(default)]
    dock: bool,
    /// Time without progress after which a goal is given up \[s\].
    patience_s: Option<f64>,
    /// Distance from a goal that counts as an arrival \[m\].
    tolerance_m: Option<f64>,
    /// Difference of heading that counts as an arrival \[deg\].
    heading_tolerance_deg: Option<f64>,
    /// Behaviour if an obstacle blocks the path to a goal.
    when_blocked: Option<WhenBlocked>,
    /// Whether the robot drives on to the next goal without a stop.
    #[serde(default)]
    pass_through: bool,
}

/// Reads a mission.
///
/// ```toml
/// places = "places.toml"   # only where a task names a place
/// [[task]]
/// explore = true
/// [[task]]
/// go = [3.0, 1.0, 90.0]    # m, m, deg, map frame
/// [[task]]
/// place = "desk"
/// tolerance_m = 0.3        # near enough; without it the robot settles exactly
/// when_blocked = "wait"    # or "detour"
/// patience_s = 600
/// [[task]]
/// return = true
/// [[task]]
/// turn_deg = 90            # turn on the spot, to the left
/// [[task]]
/// straight_m = -0.5        # drive straight, here back
/// [[task]]
/// dock = true              # drive onto the charging station
/// ```
///
/// # Errors
/// Names the file and the line or task, and the fault.
pub fn read_mission(file: &Path) -> Result<Mission, AppError> {
    let MissionFile { places, task: entries } = read_toml(file)?;
    let problem = |what: String| AppError::Input(format!("{}: {what}", file.display()));
    if entries.is_empty() {
        return Err(problem("the mission has no task, expected at least one [[task]]".to_owned()));
    }
    let places = places.map(|name| read_places(&file.with_file_name(name))).transpose()?.unwrap_or_default();
    let tasks: Result<Vec<Task>, String> = entries
        .iter()
        .enumerate()
        .map(|(i, entry)| task(entry, &places).map_err(|what| format!("task {}: {what}", i + 1)))
        .collect();
    Mission::new(tasks.map_err(problem)?).map_err(|invalid| problem(invalid.to_string()))
}

/// Speed of a straight drive of a mission file \[m/s\]. Source: ours.
const STRAIGHT_SPEED_M_S: f64 = 0.2;
/// Kinds of a task.
const TASK_FORMS: &str = "expected one of go = [X, Y, DEG], place = NAME, explore = true, turn_deg = DEG, straight_m = M, return = true, dock = true";

/// Keys of a goal's settings.
const GOAL_KEYS: &str = "patience_s, tolerance_m, heading_tolerance_deg, when_blocked and pass_through";

fn task(entry: &TaskEntry, places: &BTreeMap<String, Pose2>) -> Result<Task, String> {
    let go = entry.go.map(|[x, y, heading_deg]| Ok(Task::go(Pose2::new(x, y, heading_deg.to_radians()))));
    let turn = entry.turn_deg.map(|angle| Ok(Task::Turn { angle: angle.to_radians() }));
    let straight =
        entry.straight_m.map(|distance| Ok(Task::Straight { distance, speed: STRAIGHT_SPEED_M_S }));
    let place = entry.place.as_ref().map(|name| place(name, places));
    let words = [(entry.explore, Task::Explore), (entry.back, Task::Return), (entry.dock, Task::Dock)];
    let words = words.into_iter().filter_map(|(stands, task)| stands.then_some(Ok(task)));
    let mut forms = [go, turn, straight, place].into_iter().flatten().chain(words);
    match (forms.next(), forms.next()) {
        (Some(task), None) => with_options(task?, entry.goal_options()),
        _ => Err(TASK_FORMS.to_owned()),
    }
}

/// A task with the settings of its goal.
fn with_options(task: Task, options: GoalOptions) -> Result<Task, String> {
    match task {
        Task::Go(goal) => Ok(Task::Go(TaskGoal::new(goal.pose, options))),
        other if options == GoalOptions::default() => Ok(other),
        _ => Err(format!(
            "{GOAL_KEYS} are settings of a goal: expected go = [X, Y, DEG] or place = NAME beside them"
        )),
    }
}

impl TaskEntry {
    /// The settings of a goal.
    fn goal_options(&self) -> GoalOptions {
        let mut options = GoalOptions::default();
        options.patience = self.patience_s;
        options.tolerance = self.tolerance_m;
        options.heading_tolerance = self.heading_tolerance_deg.map(f64::to_radians);
        options.when_blocked = self.when_blocked;
        options.pass_through = self.pass_through;
        options
    }
}

fn place(name: &str, places: &BTreeMap<String, Pose2>) -> Result<Task, String> {
    places.get(name).map(|pose| Task::go(*pose)).ok_or_else(|| {
        let known: Vec<&str> = places.keys().map(String::as_str).collect();
        match known.as_slice() {
            [] => format!("no place '{name}': the mission names no file of places (places = FILE)"),
            _ => format!("no place '{name}'; there are: {}", known.join(", ")),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Mission, String> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("places.toml"), "[desk]\nx = 1.0\ny = 2.0\nheading_deg = 90\n")
            .unwrap();
        let file = folder.path().join("mission.toml");
        std::fs::write(&file, text).unwrap();
        let parent = format!("{}/", folder.path().display());
        read_mission(&file).map_err(|error| error.to_string().replace(&parent, ""))
    }

    #[test]
    fn tasks_come_in_the_order_of_the_file() {
        let text = "places = \"places.toml\"\n[[task]]\nexplore = true\n[[task]]\ngo = [3, 1, 180]\n\
                    [[task]]\nplace = \"desk\"\n[[task]]\nreturn = true\n[[task]]\ndock = true\n\
                    [[task]]\nturn_deg = -90\n[[task]]\nstraight_m = -0.5\n";
        let desk = Pose2::new(1.0, 2.0, 90_f64.to_radians());
        let goal = Pose2::new(3.0, 1.0, 180_f64.to_radians());
        assert_eq!(
            read(text).unwrap().tasks(),
            [
                Task::Explore,
                Task::go(goal),
                Task::go(desk),
                Task::Return,
                Task::Dock,
                Task::Turn { angle: -90_f64.to_radians() },
                Task::Straight { distance: -0.5, speed: STRAIGHT_SPEED_M_S },
            ]
        );
    }

    #[test]
    fn a_goal_has_settings_of_its_own() {
        let text = "places = \"places.toml\"\n[[task]]\ngo = [3, 1, 180]\npatience_s = 600\nwhen_blocked = \"wait\"\n\
                    [[task]]\nplace = \"desk\"\ntolerance_m = 0.3\nheading_tolerance_deg = 90\n";
        let mission = read(text).unwrap();
        let options = |i: usize| match mission.tasks()[i] {
            Task::Go(goal) => goal.options,
            other => panic!("{other}"),
        };
        let plain = GoalOptions::default();
        let mut waits = plain;
        waits.patience = Some(600.0);
        waits.when_blocked = Some(WhenBlocked::Wait);
        assert_eq!(options(0), waits);
        let (tolerance, heading_tolerance) = (Some(0.3), Some(90_f64.to_radians()));
        let mut near = plain;
        near.tolerance = tolerance;
        near.heading_tolerance = heading_tolerance;
        assert_eq!(options(1), near);
    }

    #[test]
    fn errors_name_the_task_and_what_is_expected() {
        for (text, expected) in [
            ("task = []\n", "mission.toml: the mission has no task, expected at least one [[task]]"),
            (
                "[[task]]\ngo = [1, 2, 3]\n[[task]]\nplace = \"desk\"\n",
                "mission.toml: task 2: no place 'desk': the mission names no file of places (places = FILE)",
            ),
            (
                "places = \"places.toml\"\n[[task]]\nplace = \"door\"\n",
                "mission.toml: task 1: no place 'door'; there are: desk",
            ),
            (
                "[[task]]\ngo = [1, 2, 3]\nexplore = true\n",
                "mission.toml: task 1: expected one of go = [X, Y, DEG], place = NAME, explore = true, turn_deg = DEG, ",
            ),
            ("[[task]]\ngo = [1, 2]\n", "mission.toml, line 2: go has 2 values, expected a list of 3 values"),
            (
                "[[task]]\ngoal = 1\n",
                "mission.toml, line 2: unknown key goal, expected one of go, turn_deg, straight_m, place, explore, return, dock",
            ),
            (
                "[[task]]\ngo = [1, 2, 3]\npatience_s = 0\n",
                "mission.toml: patience of the goal of task 1 is 0 s, expected 1 to 3600",
            ),
            (
                "[[task]]\nexplore = true\ntolerance_m = 0.3\n",
                "mission.toml: task 1: patience_s, tolerance_m, heading_tolerance_deg, when_blocked and pass_through are settings of a goal: ",
            ),
            (
                "[[task]]\ngo = [1, 2, 3]\npass_through = true\n",
                "mission.toml: pass_through of the goal of task 1 is true, expected a tolerance",
            ),
            (
                "[[task]]\ngo = [1, 2, 3]\nwhen_blocked = \"push\"\n",
                "mission.toml, line 3: when_blocked is push, expected detour or wait",
            ),
            ("[[task]]\ngo = [1, nan, 3]\n", "mission.toml: y of the goal of task 1 is NaN m, expected "),
            (
                "[[task]]\ngo = [1, 2, 3, 4]\n",
                "mission.toml, line 2: go has 4 values, expected a list of 3 values",
            ),
            (
                "[[task]]\nstraight_m = 1e3\n",
                "mission.toml: distance of task 1 is 1000 m, expected -100 to 100",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
