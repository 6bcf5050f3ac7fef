//! Commands of a page reach the robot, and refusals return.

use crate::browser::Browser;
use crate::live_run::LiveRun;
use serde_json::json;
use std::time::{Duration, Instant};
use trundle_app::operator::RunView;
use trundle_core::Pose2;
use trundle_live::Access;
use trundle_runtime::{MotionHold, Task};

#[test]
fn goals_become_the_mission_and_more_goals_queue_behind_it() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let goal = |x: f64| json!({"x": x, "y": 0.5, "theta": 1.0});
    assert_eq!(page.ask(json!({"type": "go", "goals": [goal(1.0)]})), None);
    let has = |x: f64| move |task: &Task| matches!(task, Task::Go(goal) if goal.pose.x == x);
    run.wait_for("the goal", |view| view.mission.left.iter().any(has(1.0)));
    assert_eq!(page.ask(json!({"type": "go", "goals": [goal(2.0)], "append": true})), None);
    run.wait_for("both goals", |view| {
        view.mission.left.len() == 2 && has(1.0)(&view.mission.left[0]) && has(2.0)(&view.mission.left[1])
    });
    let state = page.wait_for("state");
    assert_eq!(state["wheel"]["is_you"], true);
    assert_eq!(page.ask(json!({"type": "explore"})), None);
    run.wait_for("explore", |view| view.mission.task == Some(Task::Explore));
}

#[test]
fn a_goal_that_is_out_of_range_is_refused_with_the_reason() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    let refusal = page.ask(json!({"type": "go", "goals": [{"x": 1e12, "y": 0, "theta": 0}]})).unwrap();
    assert!(refusal.contains("x of the goal"), "{refusal}");
    assert!(page.ask(json!({"type": "go", "goals": []})).unwrap().contains("expected 1 to 50"));
}

#[test]
fn a_stop_holds_the_robot_at_once_and_the_next_goal_lets_it_go() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    assert_eq!(page.ask(json!({"type": "explore"})), None);
    run.wait_for("explore", |view| view.mission.task == Some(Task::Explore));
    let pressed = Instant::now();
    assert_eq!(page.ask(json!({"type": "stop"})), None);
    run.wait_for("held", |view| view.hold == Some(MotionHold::Paused) && view.mission.left.is_empty());
    assert!(pressed.elapsed() < Duration::from_millis(200), "{:?}", pressed.elapsed());
    assert_eq!(page.ask(json!({"type": "return"})), None);
    run.wait_for("free", |view| view.hold.is_none() && view.mission.task == Some(Task::Return));
    assert_eq!(page.ask(json!({"type": "pause"})), None);
    assert_eq!(page.ask(json!({"type": "explore"})), None);
    run.wait_for("a pause stays", |view| view.mission.task == Some(Task::Explore) && view.hold.is_some());
    assert_eq!(page.ask(json!({"type": "continue"})), None);
    run.wait_for("on", |view| view.hold.is_none());
}

#[test]
fn driving_by_hand_pauses_the_mission_and_a_viewer_that_goes_stops_the_robot() {
    let run = LiveRun::start();
    let mut page = Browser::enter(&run, Access::Drive, "page");
    page.send(&json!({"type": "drive", "v": 0.5, "omega": 0.0}));
    run.wait_for("by hand", |view| view.hold == Some(MotionHold::Paused));
    drop(page);
    let mut other = Browser::enter(&run, Access::Drive, "other");
    assert_eq!(other.ask(json!({"type": "return"})), None, "the wheel is free again");
}

/// A person who holds the key down: a twist each 50 ms.
fn hold_key(driver: &mut Browser, times: usize) {
    for _ in 0..times {
        driver.send(&json!({"type": "drive", "v": 0.5, "omega": 0.0}));
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// A twist that reaches the robot pauses its mission.
fn is_driven(view: &RunView) -> bool {
    view.hold == Some(MotionHold::Paused)
}

#[test]
fn a_stop_holds_against_a_hand_that_goes_on_until_it_lets_go() {
    let run = LiveRun::start();
    let mut driver = Browser::enter(&run, Access::Drive, "driver");
    let mut other = Browser::enter(&run, Access::Drive, "other");
    hold_key(&mut driver, 3);
    run.wait_for("by hand", is_driven);
    assert_eq!(other.ask(json!({"type": "stop"})), None);
    hold_key(&mut driver, 1);
    assert_eq!(driver.ask(json!({"type": "continue"})), None);
    run.wait_for("no pause", |view| !is_driven(view));
    hold_key(&mut driver, 10);
    assert!(!is_driven(&run.view()), "a hand drives on after a stop");
    let refusal = driver.wait_for("refused");
    assert!(
        refusal["refusal"].as_str().is_some_and(|text| text.contains("release the control")),
        "{refusal}"
    );
    driver.send(&json!({"type": "drive", "v": 0.0, "omega": 0.0}));
    assert_eq!(driver.ask(json!({"type": "continue"})), None);
    run.wait_for("no pause", |view| !is_driven(view));
    hold_key(&mut driver, 1);
    run.wait_for("by hand again", is_driven);
}

/// The twists of a person who holds the key down without the wheel are refused; that is no release.
#[test]
fn a_stop_holds_against_a_hand_that_had_lost_the_wheel() {
    let run = LiveRun::start();
    let mut driver = Browser::enter(&run, Access::Drive, "driver");
    let mut other = Browser::enter(&run, Access::Drive, "other");
    hold_key(&mut driver, 3);
    assert_eq!(other.ask(json!({"type": "take_wheel"})), None);
    hold_key(&mut driver, 10);
    assert_eq!(other.ask(json!({"type": "stop"})), None);
    hold_key(&mut driver, 1);
    assert_eq!(other.ask(json!({"type": "continue"})), None);
    run.wait_for("no pause", |view| !is_driven(view));
    drop(other);
    hold_key(&mut driver, 20);
    assert!(!is_driven(&run.view()), "a hand drives on after a stop");
    std::thread::sleep(Duration::from_millis(400));
    hold_key(&mut driver, 1);
    run.wait_for("by hand again", is_driven);
}

#[test]
fn a_given_pose_moves_the_robot_on_the_map() {
    let run = LiveRun::start();
    run.wait_for("a step", |view| view.odometry.is_some());
    let mut page = Browser::enter(&run, Access::Drive, "page");
    assert_eq!(page.ask(json!({"type": "set_pose", "pose": {"x": 3.0, "y": -1.0, "theta": 0.5}})), None);
    let given = Pose2::new(3.0, -1.0, 0.5);
    run.wait_for("the pose", |view| view.estimate.pose.distance(&given) < 0.05);
}

#[test]
fn a_recording_is_switched_and_its_state_is_shown() {
    let run = LiveRun::start();
    let mut viewer = Browser::enter(&run, Access::View, "viewer");
    assert!(viewer.ask(json!({"type": "record", "on": false})).unwrap().contains("for viewing only"));
    let mut driver = Browser::enter(&run, Access::Drive, "driver");
    let first = driver.wait_for("recording");
    assert_eq!((&first["on"], &first["file"]), (&json!(true), &json!("recording.mcap")));
    let mut turn = |on: bool| {
        assert_eq!(driver.ask(json!({"type": "record", "on": on})), None);
        std::iter::from_fn(|| Some(driver.wait_for("recording"))).find(|state| state["on"] == on).unwrap()
    };
    assert_eq!(turn(false)["reason"], json!(null));
    let second = turn(true);
    assert_eq!(second["file"], "recording-2.mcap");
    assert!(second["free_mb"].as_u64().is_some_and(|free| free > 0), "{second}");
}
