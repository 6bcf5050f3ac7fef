//! Instant actions.

use crate::robot::{MAP, TestRobot, errors, nodes, order, reference, status, with_header};
use serde_json::{Value, json};
use trundle_core::Twist2;
use trundle_runtime::{OperatorCommand, TaskEnd};

fn none() -> Value {
    json!([])
}

#[test]
fn a_cancelled_order_ends_when_the_robot_is_at_rest() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 0, 0, &[0.0, 2.0], 2));
    robot.arrive();
    robot.view.estimate.twist = Twist2::new(0.3, 0.0);
    let state = robot.instant("c", "cancelOrder", &none());
    assert_eq!((status(&state, "c"), nodes(&state)), (Some("RUNNING"), vec!["n1"]));
    let state = robot.order(&order("b", 0, 0, &[0.0], 1));
    assert_eq!(errors(&state), ["orderError"], "no order while the robot still stops");
    robot.view.estimate.twist = Twist2::new(0.0, 0.0);
    let state = robot.step();
    assert_eq!(
        (status(&state, "c"), nodes(&state), &state["orderId"]),
        (Some("FINISHED"), vec![], &json!("a"))
    );
    assert_eq!(robot.sent.last(), Some(&OperatorCommand::cancel()));
}

#[test]
fn open_actions_of_a_cancelled_order_have_failed() {
    let mut robot = TestRobot::new();
    let mut order = order("a", 0, 0, &[0.0, 2.0], 2);
    order["nodes"][1]["actions"] = json!([crate::robot::action("p", "finePositioning", "NONE", &none())]);
    robot.order(&order);
    let state = robot.instant("c", "cancelOrder", &none());
    assert_eq!(status(&state, "p"), Some("FAILED"));
}

#[test]
fn without_an_order_there_is_nothing_to_cancel() {
    let mut robot = TestRobot::new();
    let state = robot.instant("c", "cancelOrder", &none());
    assert_eq!((status(&state, "c"), errors(&state)), (Some("FAILED"), vec!["noOrderToCancel"]));
    assert_eq!(reference(&state["errors"][0], "actionId"), Some("c"));
    assert!(robot.sent.is_empty());
}

#[test]
fn a_pause_holds_until_it_is_ended() {
    let mut robot = TestRobot::new();
    let state = robot.instant("p", "startPause", &none());
    assert_eq!((status(&state, "p"), &state["paused"]), (Some("FINISHED"), &json!(true)));
    let state = robot.instant("q", "stopPause", &none());
    assert_eq!((status(&state, "q"), &state["paused"]), (Some("FINISHED"), &json!(false)));
}

#[test]
fn a_pose_is_given_by_its_numbers_and_map() {
    let mut robot = TestRobot::new();
    let pose = |x: Value, map: &str| {
        json!([
            { "key": "x", "value": x }, { "key": "y", "value": "2.5" }, { "key": "theta", "value": 1 },
            { "key": "mapId", "value": map }, { "key": "lastNodeId", "value": "n9" },
        ])
    };
    let state = robot.instant("i", "initPosition", &pose(json!(1), MAP));
    assert_eq!((status(&state, "i"), &state["lastNodeId"]), (Some("FINISHED"), &json!("n9")));
    assert!(matches!(robot.sent.last(), Some(OperatorCommand::SetPose(guess)) if guess.pose.y == 2.5));
    for (id, wrong) in [("j", pose(json!("east"), MAP)), ("k", pose(json!(1), "attic")), ("l", none())] {
        let state = robot.instant(id, "initPosition", &wrong);
        assert_eq!(
            (status(&state, id), errors(&state).last()),
            (Some("FAILED"), Some(&"instantActionError"))
        );
    }
}

#[test]
fn requests_and_unknown_actions_are_answered() {
    let mut robot = TestRobot::new();
    for (id, kind) in [("s", "stateRequest"), ("f", "factsheetRequest")] {
        assert_eq!(status(&robot.instant(id, kind, &none()), id), Some("FINISHED"));
    }
    assert!(robot.vehicle.take_state_wish() && robot.vehicle.take_factsheet_wish());
    let state = robot.instant("d", "dance", &none());
    assert_eq!((status(&state, "d"), errors(&state)), (Some("FAILED"), vec!["instantActionError"]));
}

#[test]
fn charging_ends_with_the_mission() {
    let mut robot = TestRobot::new();
    let state = robot.instant("b", "startCharging", &none());
    assert_eq!((status(&state, "b"), &state["operatingMode"]), (Some("RUNNING"), &json!("AUTOMATIC")));
    robot.end_task(TaskEnd::Done);
    assert_eq!(status(&robot.step(), "b"), Some("FINISHED"));
}

#[test]
fn garbage_and_floods_are_reported_and_bounded() {
    let mut robot = TestRobot::new();
    let many: Vec<Value> =
        (0..100).map(|i| crate::robot::action(&i.to_string(), "stateRequest", "NONE", &none())).collect();
    let many = with_header(json!({ "actions": many })).to_string();
    let deep = "[".repeat(100_000);
    let large = vec![b' '; 1_000_000];
    for payload in [b"" as &[u8], b"{}", b"\xff\xff", many.as_bytes(), deep.as_bytes(), &large] {
        let state = robot.raw_instant(payload);
        assert_eq!(errors(&state).last(), Some(&"validationError"));
    }
    for i in 0..1000 {
        robot.instant(&format!("s{i}"), "dance", &none());
    }
    let state = robot.state();
    assert!(
        state["errors"].as_array().unwrap().len() <= 10
            && state["actionStates"].as_array().unwrap().len() <= 33
    );
}
