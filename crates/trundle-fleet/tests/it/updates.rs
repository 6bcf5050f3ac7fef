//! Updates of an order, its horizon, and other orders during it.

use crate::robot::{TestRobot, errors, nodes, order};
use serde_json::json;

#[test]
fn an_update_while_driving_continues_the_base_and_replaces_the_horizon() {
    let mut robot = TestRobot::new();
    let state = robot.order(&order("a", 0, 0, &[0.0, 2.0, 9.0], 2));
    assert_eq!((nodes(&state), &state["newBaseRequest"]), (vec!["n0", "n1", "n2"], &json!(false)));
    let state = robot.arrive();
    assert_eq!(state["newBaseRequest"], true, "the robot drives to the last node of its base");
    let commands = robot.sent.len();
    let state = robot.order(&order("a", 1, 1, &[2.0, 4.0], 2));
    assert_eq!(
        (nodes(&state), &state["orderUpdateId"], robot.sent.len()),
        (vec!["n1", "n2"], &json!(1), commands)
    );
    assert_eq!(state["nodeStates"][1]["nodePosition"]["x"], 4.0);
    robot.arrive();
    assert_eq!(robot.goal().map(|goal| goal.x), Some(4.0));
}

#[test]
fn the_robot_waits_at_the_end_of_its_base_for_the_horizon() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 0, 0, &[0.0, 2.0, 4.0], 2));
    robot.arrive();
    let state = robot.arrive();
    assert_eq!((nodes(&state), robot.goal()), (vec!["n2"], None));
    assert_eq!(state["nodeStates"][0]["released"], false);
    robot.order(&order("a", 1, 1, &[2.0, 4.0], 2));
    assert_eq!(robot.goal().map(|goal| goal.x), Some(4.0));
}

#[test]
fn an_order_that_is_done_is_continued_from_its_last_node() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 0, 0, &[0.0, 2.0], 2));
    robot.arrive();
    robot.arrive();
    robot.order(&order("a", 1, 1, &[2.0, 4.0], 2));
    assert_eq!(robot.goal().map(|goal| goal.x), Some(4.0));
}

#[test]
fn updates_that_do_not_fit_are_rejected_and_the_order_goes_on() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 3, 0, &[0.0, 2.0], 2));
    robot.arrive();
    for (update, wrong) in
        [("old", order("a", 2, 1, &[2.0, 4.0], 2)), ("place", order("a", 4, 2, &[4.0, 6.0], 2))]
    {
        let state = robot.order(&wrong);
        assert_eq!(errors(&state).last(), Some(&"orderUpdateError"), "{update}");
        assert_eq!((nodes(&state), &state["orderUpdateId"]), (vec!["n1"], &json!(3)));
    }
    let before = robot.state()["errors"].clone();
    let state = robot.order(&order("a", 3, 0, &[0.0, 2.0], 2));
    assert_eq!(state["errors"], before, "the same update twice is ignored");
    assert_eq!(robot.goal().map(|goal| goal.x), Some(2.0));
}

#[test]
fn another_order_waits_until_the_present_one_is_done() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 0, 0, &[0.0, 2.0], 2));
    let state = robot.order(&order("b", 0, 0, &[0.0, 1.0], 2));
    assert_eq!((errors(&state), &state["orderId"]), (vec!["orderError"], &json!("a")));
    robot.arrive();
    robot.arrive();
    let state = robot.order(&order("b", 0, 0, &[2.0, 1.0], 2));
    assert_eq!((errors(&state).len(), &state["orderId"]), (0, &json!("b")));
}

#[test]
fn a_person_who_takes_the_robot_over_ends_the_order() {
    let mut robot = TestRobot::new();
    robot.order(&order("a", 0, 0, &[0.0, 2.0], 2));
    robot.another_mission();
    let state = robot.step();
    assert_eq!((errors(&state), &state["operatingMode"]), (vec!["orderAborted"], &json!("MANUAL")));
    assert!(nodes(&state).is_empty());
    let state = robot.order(&order("b", 0, 0, &[0.0, 2.0], 2));
    assert_eq!((errors(&state).last(), &state["orderId"]), (Some(&"orderError"), &json!("a")));
}
