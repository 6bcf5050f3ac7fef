//! The state of a robot in its master's format.

use super::instant::is_at_rest;
use super::message::{
    ChargeState, EdgeState, Information, LoadedMap, MessageHeader, NodeState, OrderProgress, RobotPosition,
    SafetyState, VehicleState, Velocity,
};
use super::order_book::OrderBook;
use super::vehicle::Vehicle;
use crate::robot_status::RobotStatus;
use trundle_core::wrap_angle;
use trundle_runtime::{DriveState, MotionHold};

/// Charge of a battery that does not report one \[%\]. Source: VDA 5050 2.1: 80 % means "good".
const UNKNOWN_CHARGE: f64 = 80.0;

/// The state of a vehicle after a view of the run.
#[must_use]
pub fn vehicle_state(vehicle: &Vehicle, header: MessageHeader, view: &RobotStatus) -> VehicleState {
    VehicleState {
        header,
        maps: vec![LoadedMap {
            map_id: vehicle.map_id.clone(),
            map_version: "1".to_owned(),
            map_status: "ENABLED",
        }],
        order: order_progress(&vehicle.book),
        agv_position: robot_position(view, &vehicle.map_id),
        velocity: velocity(view),
        loads: [],
        driving: !is_at_rest(view),
        paused: view.hold == Some(MotionHold::Paused),
        battery_state: battery_state(view),
        operating_mode: vehicle.mode(view),
        errors: vehicle.errors.all().to_vec(),
        information: information(view),
        safety_state: safety_state(view),
    }
}

fn order_progress(book: &OrderBook) -> OrderProgress {
    let last_node = book.last_node().unwrap_or_default();
    OrderProgress {
        order_id: book.order_id().to_owned(),
        order_update_id: book.update_id(),
        last_node_id: last_node.0.to_owned(),
        last_node_sequence_id: last_node.1,
        node_states: book.nodes().iter().map(NodeState::from).collect(),
        edge_states: book.edges().iter().map(EdgeState::from).collect(),
        new_base_request: book.has_horizon() && book.is_at_end_of_base(),
        action_states: book.action_states().cloned().collect(),
    }
}

/// Pose of the robot.
#[must_use]
pub fn robot_position(view: &RobotStatus, map_id: &str) -> RobotPosition {
    let pose = view.estimate.pose;
    RobotPosition {
        x: pose.x,
        y: pose.y,
        theta: wrap_angle(pose.theta),
        map_id: map_id.to_owned(),
        position_initialized: !matches!(view.state, DriveState::Lost { .. }),
        deviation_range: view.estimate.position_sigma(),
    }
}

/// Velocity of the robot.
#[must_use]
pub fn velocity(view: &RobotStatus) -> Velocity {
    let twist = view.estimate.twist;
    Velocity { vx: twist.v, vy: 0.0, omega: twist.omega }
}

fn battery_state(view: &RobotStatus) -> ChargeState {
    let charge = view.battery.and_then(|battery| battery.charge);
    ChargeState {
        battery_charge: charge.map_or(UNKNOWN_CHARGE, |charge| 100.0 * charge),
        battery_voltage: view.battery.map(|battery| battery.voltage_v),
        charging: view.battery.is_some_and(|battery| battery.is_charging),
    }
}

/// Safety stops: conditions of the body, without pauses.
fn safety_state(view: &RobotStatus) -> SafetyState {
    let field_violation = view.hold.is_some_and(|hold| hold != MotionHold::Paused);
    SafetyState { e_stop: "NONE", field_violation }
}

/// Activity of the robot, why it does not move on, and its unknowns.
fn information(view: &RobotStatus) -> Vec<Information> {
    let info = |info_type, info_description| Information { info_type, info_description, info_level: "INFO" };
    let mut all = vec![info("driveState", view.state.to_string())];
    all.extend(view.hold.map(|hold| info("hold", hold.to_string())));
    if view.battery.and_then(|battery| battery.charge).is_none() {
        all.push(info("batteryUnknown", "the base does not report the charge of its battery".to_owned()));
    }
    all
}
