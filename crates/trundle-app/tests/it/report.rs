//! The report of a run: figures, verdict, table and folder.

use crate::body::{GOAL, StillBody, run_into, setup};
use trundle_app::TrackCounts;
use trundle_app::report::{GoalOutcome, RunEnd, RunNumbers, TaskCounts, mission_text, write_run};
use trundle_core::Pose2;
use trundle_eval::{GoalError, goal_error};
use trundle_io::OutputFolder;
use trundle_runtime::{DriveState, Mission, Reason, Task, TaskEnd};

fn off(metres: f64, degrees: f64) -> Option<GoalError> {
    goal_error(GOAL, GOAL * Pose2::new(metres, 0.0, degrees.to_radians())).ok()
}

fn goal(end: TaskEnd, error: Option<GoalError>) -> GoalOutcome {
    GoalOutcome {
        task: 0,
        goal: GOAL,
        end,
        at_s: 12.3,
        error,
        believed: off(0.01, 0.0),
        bound: None,
        before_restart: false,
        allowed: GoalOutcome::exact(),
    }
}

/// The figures of a run that reached its goal.
fn good() -> RunNumbers {
    RunNumbers {
        goals: vec![goal(TaskEnd::Done, off(0.01, 1.0))],
        goals_asked: Some(1),
        goal_error: off(0.01, 1.0),
        believed_error: off(0.005, 0.5),
        estimate_rmse: Some(0.012),
        contacts: 0,
        path_length: 5.0,
        duration: 20.0,
        plans: 3,
        tracked: TrackCounts { ok: 300, weak: 4, dead_reckoned: 1, lost: 0 },
        landmarks: 900,
        keyframes: 30,
        images_dropped: vec![1.0, 2.0],
        docking: None,
        end: RunEnd {
            state: DriveState::Arrived,
            is_operated: false,
            of_sensors: None,
            out_of_time: None,
            allowed: GoalOutcome::exact(),
            tasks: TaskCounts { done: 1, left: 0 },
        },
    }
}

#[test]
fn a_run_is_a_success_when_the_goal_is_reached_in_truth_and_nothing_is_touched() {
    assert!(good().is_success());
    assert_eq!(good().verdict(), "Goal reached, nothing touched.");
    let two = RunNumbers { goals: vec![goal(TaskEnd::Done, off(0.0, 0.0)); 2], ..good() };
    assert_eq!(two.verdict(), "All 2 goals reached, nothing touched.");
    let none = RunNumbers { goals: Vec::new(), goal_error: None, ..good() };
    assert_eq!(none.verdict(), "Mission done, nothing touched.");
    let idle = RunNumbers { goals_asked: None, ..good() };
    assert!(!idle.is_success());
    assert_eq!(idle.verdict(), "Failed: the goal is the start, so the robot had nothing to do.");
}

#[test]
fn an_operated_run_is_a_success_only_when_something_was_done_and_nothing_is_open() {
    let interrupted = DriveState::Stopped { reason: Reason::Interrupted };
    let operated = |done, left| RunNumbers {
        goals: Vec::new(),
        end: RunEnd {
            state: interrupted.clone(),
            is_operated: true,
            of_sensors: None,
            out_of_time: None,
            allowed: GoalOutcome::exact(),
            tasks: TaskCounts { done, left },
        },
        ..good()
    };
    let done = operated(2, 0);
    assert!(done.is_success(), "an operator ends a run by Ctrl-C");
    assert_eq!(done.verdict(), "Mission done, nothing touched.");
    for (done, left, verdict) in [
        (0, 3, "Failed: 3 tasks were open at the end, 0 done."),
        (1, 2, "Failed: 2 tasks were open at the end, 1 done."),
        (0, 0, "Failed: no task was done."),
    ] {
        let numbers = operated(done, left);
        assert_eq!((numbers.is_success(), numbers.verdict().as_str()), (false, verdict));
    }
    let touched = RunNumbers { contacts: 2, ..operated(1, 0) };
    assert_eq!(touched.verdict(), "Failed: 2 contacts with obstacles.");
}

#[test]
fn each_fault_is_named_in_the_verdict() {
    let stopped = DriveState::Stopped { reason: Reason::PoseUnknown };
    let cases = [
        (RunNumbers { contacts: 2, ..good() }, "2 contacts with obstacles"),
        (RunNumbers { goal_error: off(0.06, 0.0), ..good() }, "6.0 cm and 0.0 deg off the goal"),
        (RunNumbers { goal_error: off(0.0, 4.0), ..good() }, "0.0 cm and 4.0 deg off the goal"),
        (
            RunNumbers { end: RunEnd { state: stopped, ..good().end }, ..good() },
            "did not arrive (stopped: the pose is unknown",
        ),
        (RunNumbers { goals: vec![goal(TaskEnd::Done, off(0.2, 0.0))], ..good() }, "at 1 goals"),
    ];
    for (numbers, fault) in cases {
        let verdict = numbers.verdict();
        assert!(!numbers.is_success() && verdict.starts_with("Failed: "), "{verdict}");
        assert!(verdict.contains(fault), "'{verdict}' does not name '{fault}'");
    }
}

#[test]
fn a_goal_is_reached_within_distance_and_turn_and_when_the_task_is_done() {
    let reached = |end, error| goal(end, error).is_reached();
    assert!(reached(TaskEnd::Done, off(0.04, 2.0)));
    assert!(!reached(TaskEnd::Done, off(0.06, 0.0)) && !reached(TaskEnd::Done, off(0.0, 4.0)));
    assert!(reached(TaskEnd::Done, None), "without truth the estimate decides");
    let off_by_estimate = GoalOutcome { believed: off(0.2, 0.0), ..goal(TaskEnd::Done, None) };
    assert!(!off_by_estimate.is_reached());
    let given_up = || TaskEnd::GivenUp { reason: Reason::MovingObstacle };
    assert!(!reached(given_up(), off(0.0, 0.0)));
    let earlier = GoalOutcome { before_restart: true, ..goal(TaskEnd::Done, None) };
    assert!(earlier.is_reached(), "of a run before a restart only the estimate is known");
}

#[test]
fn the_rows_of_a_goal_say_where_when_and_how() {
    let row = goal(TaskEnd::PutOff { reason: Reason::MovingObstacle }, off(0.5, 0.0)).row();
    assert_eq!(row[0], "goal 1 at (1.00 m, 0.00 m, 0 deg)");
    assert_eq!(row[1], "12.3 s: put off: a moving obstacle blocks the path, 50.0 cm, 0.00 deg");
    let earlier = GoalOutcome { before_restart: true, ..goal(TaskEnd::Done, None) };
    assert_eq!(earlier.row()[1], "done, before it was switched off; estimated error 1.0 cm, 0.00 deg");
}

#[test]
fn the_table_has_a_row_for_each_figure() {
    let value = |name: &str| {
        let rows = good().run_rows();
        rows.iter().find(|row| row[0] == name).map(|row| row[1].clone()).unwrap_or_default()
    };
    assert_eq!(value("goal error against truth"), "1.0 cm, 1.00 deg");
    assert_eq!(value("estimate against truth, rmse"), "1.2 cm");
    assert_eq!(value("images ok / weak / dead reckoned / lost"), "300 / 4 / 1 / 0");
    assert_eq!(value("images dropped"), "2");
    assert_eq!(value("keyframes, landmarks"), "30, 900");
    let goals = RunNumbers { goals: vec![goal(TaskEnd::Done, None); 2], ..good() };
    assert_eq!(
        goals.run_rows().len(),
        good().run_rows().len() + 2,
        "goals are listed where there are several"
    );
}

#[test]
fn the_sentences_of_a_mission_are_in_order() {
    let mission = Mission::new(vec![Task::Explore, Task::go(GOAL), Task::Return]).unwrap();
    assert_eq!(mission_text(&mission), "explore, go to (1.00 m, 0.00 m, 0 deg), return to the start");
    assert_eq!(mission_text(&Mission::default()), "");
}

#[test]
fn the_folder_of_a_run_is_whole_and_names_the_kinds_of_its_reason() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = OutputFolder::create(&scratch.path().join("run")).unwrap();
    let mut run = run_into(&setup(), &mut StillBody::touched(), &folder).unwrap();
    let output = write_run(&setup(), &mut run, None, folder).unwrap();
    assert!(output.incomplete.is_none() && !output.numbers.is_success());
    let files = ["map.pgm", "map.yaml", "map.png", "trajectory.txt", "groundtruth.txt", "report.html"];
    for name in files.into_iter().chain(["timing.html", "summary.json", "recording.mcap"]) {
        assert!(output.folder.join(name).is_file(), "{name}");
    }
    let text = |name: &str| std::fs::read_to_string(output.folder.join(name)).unwrap();
    let (report, timing) = (text("report.html"), text("timing.html"));
    assert!(report.contains("<a href=\"./timing.html\">") && timing.contains("<a href=\"./report.html\">"));
    assert!(report.contains("<summary><h3>Changes of state: ") && !timing.contains("<summary>"));
    assert!(report.contains("<td>stopped</td><td>task 1 (go to "), "{report}");
    let text = text("summary.json");
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["success"], false);
    assert_eq!(summary["reason_kinds"], serde_json::json!(["tasks_failed", "repeated_contact"]));
    let end = &summary["goals"][0]["end"]["given_up"];
    assert_eq!(end["reason"], "3 bumper contacts on the path");
    assert_eq!(end["kinds"][0], "repeated_contact");
    assert!(summary["state"].as_str().unwrap().starts_with("stopped: task 1 (go to"));
}
