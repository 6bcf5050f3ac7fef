//! Orders that are carried out, and orders that are rejected.

use crate::robot::{TestRobot, action, errors, nodes, order, reference, status};
use serde_json::{Value, json};
use std::time::Duration;
use trundle_runtime::{OperatorCommand, Reason, RunSetting, TaskEnd};

#[test]
fn an_order_is_driven_node_by_node() {
    let mut robot = TestRobot::new();
    let state = robot.order(&order("a", 0, 0, &[0.0, 2.0, 4.0], 3));
    assert_eq!((nodes(&state), errors(&state).len()), (vec!["n0", "n1", "n2"], 0));
    let state = robot.arrive();
    assert_eq!((nodes(&state), &state["lastNodeId"]), (vec!["n1", "n2"], &json!("n0")));
    assert_eq!(robot.goal().map(|goal| goal.x), Some(2.0));
    let state = robot.arrive();
    assert_eq!((&state["lastNodeSequenceId"], state["edgeStates"].as_array().unwrap().len()), (&json!(2), 1));
    let state = robot.arrive();
    assert_eq!((nodes(&state), &state["lastNodeId"], &state["orderId"]), (vec![], &json!("n2"), &json!("a")));
}

#[test]
fn a_node_within_its_deviation_is_reached_without_a_stop() {
    let mut robot = TestRobot::new();
    let mut rolling = order("a", 0, 0, &[0.0, 2.0, 4.0], 3);
    for i in 0..2 {
        let position = &mut rolling["nodes"][i]["nodePosition"];
        (position["allowedDeviationXY"], position["allowedDeviationTheta"]) = (json!(0.5), json!(3.0));
    }
    robot.order(&rolling);
    robot.step();
    assert_eq!(
        robot.goal().map(|goal| goal.x),
        Some(2.0),
        "the first node is reached where the robot stands"
    );
    robot.view.estimate.pose.x = 1.6;
    robot.step();
    assert_eq!(robot.goal().map(|goal| goal.x), Some(4.0));
}

#[test]
fn actions_at_a_node_hold_the_robot_by_their_blocking_type() {
    let mut robot = TestRobot::new();
    let mut order = order("a", 0, 0, &[0.0, 2.0], 2);
    let second = json!([{ "key": "duration", "value": 1 }]);
    order["nodes"][0]["actions"] =
        json!([action("w", "wait", "HARD", &second), action("p", "finePositioning", "NONE", &json!([]))]);
    let state = robot.order(&order);
    assert_eq!(status(&state, "w"), Some("WAITING"));
    let state = robot.arrive();
    assert_eq!(
        (status(&state, "w"), status(&state, "p"), robot.goal()),
        (Some("RUNNING"), Some("WAITING"), None)
    );
    robot.step_by(Duration::from_secs(1));
    let state = robot.step();
    assert_eq!((status(&state, "w"), status(&state, "p")), (Some("FINISHED"), Some("FINISHED")));
    assert_eq!(robot.goal().map(|goal| goal.x), Some(2.0));
}

#[test]
fn the_speed_limit_of_an_edge_holds_on_that_edge() {
    let mut robot = TestRobot::new();
    let mut slow = order("a", 0, 0, &[0.0, 2.0, 4.0], 3);
    slow["edges"][0]["maxSpeed"] = json!(0.2);
    robot.order(&slow);
    robot.arrive();
    robot.arrive();
    let limits: Vec<f64> = robot
        .sent
        .iter()
        .filter_map(|command| match command {
            OperatorCommand::Change(RunSetting::Speed(speed)) => Some(*speed),
            _ => None,
        })
        .collect();
    assert_eq!(limits, [0.2, 0.7]);
}

#[test]
fn a_node_that_cannot_be_reached_is_reported_and_tried_again() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 0, 0, &[0.0, 2.0], 2));
    robot.arrive();
    robot.end_task(TaskEnd::GivenUp { reason: Reason::MovingObstacle });
    let state = robot.step();
    assert_eq!((errors(&state), nodes(&state)), (vec!["driveError"], vec!["n1"]));
    assert_eq!(reference(&state["errors"][0], "nodeId"), Some("n1"));
    assert_eq!(robot.goal(), None);
    robot.step_by(Duration::from_secs(11));
    robot.step();
    assert_eq!(robot.goal().map(|goal| goal.x), Some(2.0));
    assert!(errors(&robot.arrive()).is_empty());
}

/// A state after one order to a new robot; `change` modifies the order.
fn rejected(change: impl Fn(&mut Value)) -> Value {
    let mut robot = TestRobot::new();
    let mut order = order("a", 0, 0, &[0.0, 2.0], 2);
    change(&mut order);
    let state = robot.order(&order);
    assert!(robot.sent.is_empty() && nodes(&state).is_empty(), "{order}");
    assert_eq!(state["orderId"], "");
    state["errors"][0].clone()
}

#[test]
fn orders_of_another_form_are_rejected() {
    let changes: [fn(&mut Value); 12] = [
        |order| order["nodes"] = json!([]),
        |order| order["edges"] = json!([]),
        |order| order["nodes"][1]["sequenceId"] = json!(3),
        |order| order["nodes"][1]["released"] = json!(false),
        |order| order["nodes"][0]["released"] = json!(false),
        |order| order["edges"][0]["endNodeId"] = json!("n7"),
        |order| order["nodes"][1]["nodePosition"]["x"] = json!(1e300),
        |order| order["nodes"][1]["nodePosition"]["theta"] = json!(7),
        |order| order["orderId"] = json!("a".repeat(300)),
        |order| order["orderUpdateId"] = json!(-1),
        |order| _ = order.as_object_mut().unwrap().remove("headerId"),
        |order| {
            let twice = action("w", "finePositioning", "NONE", &json!([]));
            order["nodes"][0]["actions"] = json!([twice, twice]);
        },
    ];
    for change in changes {
        let error = rejected(change);
        assert_eq!(
            (error["errorType"].as_str(), error["errorLevel"].as_str()),
            (Some("validationError"), Some("WARNING"))
        );
        assert_eq!(reference(&error, "topic"), Some("order"));
    }
}

#[test]
fn orders_that_the_robot_cannot_do_are_rejected_with_the_field() {
    type Change = fn(&mut Value);
    let changes: [(Change, &str, &str); 7] = [
        (|order| order["nodes"][1]["nodePosition"]["mapId"] = json!("attic"), "nodePosition.mapId", "attic"),
        (|order| order["edges"][0]["trajectory"] = json!({ "degree": 1 }), "field", "trajectory"),
        (|order| order["edges"][0]["rotationAllowed"] = json!(false), "field", "rotationAllowed"),
        (|order| order["edges"][0]["maxSpeed"] = json!(0.01), "field", "maxSpeed"),
        (|order| order["edges"][0]["maxHeight"] = json!(0.1), "field", "maxHeight"),
        (
            |order| order["nodes"][1]["actions"] = json!([action("lift", "pick", "HARD", &json!([]))]),
            "actionType",
            "pick",
        ),
        (
            |order| order["nodes"][1]["actions"] = json!([action("w", "wait", "HARD", &json!([]))]),
            "actionId",
            "w",
        ),
    ];
    for (change, key, value) in changes {
        let error = rejected(change);
        assert_eq!(error["errorType"], "orderError", "{error}");
        assert_eq!(reference(&error, key), Some(value), "{error}");
        assert_eq!(
            (reference(&error, "orderId"), reference(&error, "orderUpdateId")),
            (Some("a"), Some("0"))
        );
    }
}

#[test]
fn an_order_must_begin_where_the_robot_stands() {
    let error = rejected(|order| order["nodes"][0]["nodePosition"]["x"] = json!(1.0));
    assert_eq!(
        (error["errorType"].as_str(), reference(&error, "nodeId")),
        (Some("noRouteError"), Some("n0"))
    );
}

#[test]
fn an_error_stays_until_an_order_is_accepted() {
    let mut robot = TestRobot::new();
    robot.vehicle.on_order(b"{", &robot.view);
    assert_eq!(errors(&robot.step_by(Duration::from_secs(100))), ["validationError"]);
    assert!(errors(&robot.order(&order("a", 0, 0, &[0.0], 1))).is_empty());
}
