//! A robot that acts immediately, and messages to it.

use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Duration;
use trundle_app::operator::MissionView;
use trundle_core::{DriveLimits, Footprint, Pose2};
use trundle_fleet::vda5050::message::{HeaderCounter, Identity, Topic};
use trundle_fleet::vda5050::{Vehicle, vehicle_state};
use trundle_fleet::{RobotCommands, RobotFacts, RobotStatus};
use trundle_runtime::{Mission, MotionHold, OperatorCommand, Task, TaskEnd, TaskRecord};

/// The map of the tests.
pub const MAP: &str = "hall";

/// A robot that acts immediately but drives only at a test's request.
pub struct TestRobot {
    pub vehicle: Vehicle,
    pub view: RobotStatus,
    pub sent: Vec<OperatorCommand>,
    headers: HeaderCounter,
}

struct Commands<'a> {
    view: &'a mut RobotStatus,
    sent: &'a mut Vec<OperatorCommand>,
}

impl RobotCommands for Commands<'_> {
    fn send(&mut self, command: OperatorCommand) -> Result<u64, String> {
        self.sent.push(command.clone());
        let id = self.sent.len() as u64;
        match command {
            OperatorCommand::Begin(mission) => self.view.mission = mission_view(id, &mission),
            OperatorCommand::Pause => self.view.hold = Some(MotionHold::Paused),
            OperatorCommand::Continue => self.view.hold = None,
            _ => {}
        }
        Ok(id)
    }

    fn stop(&mut self) -> Result<(), String> {
        self.send(OperatorCommand::cancel()).map(drop)
    }
}

fn mission_view(id: u64, mission: &Mission) -> MissionView {
    let left = mission.tasks().to_vec();
    MissionView { id, task: left.first().copied(), left: Arc::new(left), ..MissionView::default() }
}

impl TestRobot {
    /// A robot at the origin, at rest.
    pub fn new() -> Self {
        let facts = RobotFacts {
            title: "test".to_owned(),
            footprint: Footprint::KOBUKI,
            limits: DriveLimits::KOBUKI,
            height_m: 0.5,
        };
        let identity = Identity { manufacturer: "trundle".to_owned(), serial_number: "r1".to_owned() };
        let (vehicle, headers) = (Vehicle::new(facts, MAP), HeaderCounter::new(identity));
        Self { vehicle, view: RobotStatus::at_rest(Pose2::new(0.0, 0.0, 0.0)), sent: Vec::new(), headers }
    }

    /// A message of the master on the topic `order`.
    pub fn order(&mut self, order: &Value) -> Value {
        self.vehicle.on_order(order.to_string().as_bytes(), &self.view);
        self.step()
    }

    /// An instant action of the master.
    pub fn instant(&mut self, id: &str, kind: &str, parameters: &Value) -> Value {
        let action = json!({ "actionId": id, "actionType": kind, "blockingType": "HARD", "actionParameters": parameters });
        self.raw_instant(with_header(json!({ "actions": [action] })).to_string().as_bytes())
    }

    /// Any bytes on the topic of instant actions.
    pub fn raw_instant(&mut self, payload: &[u8]) -> Value {
        let view = self.view.clone();
        let mut commands = Commands { view: &mut self.view, sent: &mut self.sent };
        self.vehicle.on_instant_actions(payload, &view, &mut commands);
        self.step()
    }

    /// A step of 50 ms; the state after it.
    pub fn step(&mut self) -> Value {
        self.step_by(Duration::from_millis(50))
    }

    /// A longer step; the state after it.
    pub fn step_by(&mut self, passed: Duration) -> Value {
        let view = self.view.clone();
        let mut commands = Commands { view: &mut self.view, sent: &mut self.sent };
        self.vehicle.step(passed, &view, &mut commands);
        self.state()
    }

    /// The state as JSON.
    pub fn state(&mut self) -> Value {
        let header = self.headers.header(Topic::State);
        serde_json::to_value(vehicle_state(&self.vehicle, header, &self.view)).unwrap()
    }

    /// The goal that the robot drives to.
    pub fn goal(&self) -> Option<Pose2> {
        match self.view.mission.task {
            Some(Task::Go(goal)) if !self.view.mission.is_over => Some(goal.pose),
            _ => None,
        }
    }

    /// Moves the robot to its goal; returns the state after two steps.
    pub fn arrive(&mut self) -> Value {
        self.view.estimate.pose = self.goal().unwrap();
        self.end_task(TaskEnd::Done);
        self.step();
        self.step()
    }

    /// The present task ends.
    pub fn end_task(&mut self, end: TaskEnd) {
        let task = self.view.mission.task.take().unwrap();
        let (stamp, pose) = (self.view.estimate.stamp, self.view.estimate.pose);
        let record = TaskRecord {
            index: 0,
            task,
            end,
            from: stamp,
            to: stamp,
            pose,
            bound: None,
            before_restart: false,
        };
        self.view.mission.ended = Arc::new(vec![record]);
        self.view.mission.is_over = true;
    }

    /// Another front end gives the robot a mission.
    pub fn another_mission(&mut self) {
        self.view.mission = mission_view(1000, &Mission::new(vec![Task::Explore]).unwrap());
    }
}

/// A message with the header of a master.
pub fn with_header(mut message: Value) -> Value {
    let header = json!({
        "headerId": 1, "timestamp": "2026-11-26T16:00:00.00Z", "version": "2.1.0", "manufacturer": "trundle",
        "serialNumber": "r1",
    });
    message.as_object_mut().unwrap().extend(header.as_object().unwrap().clone());
    message
}

/// An order along the x axis with nodes at these positions; the first `released` are the base. `first` is the index of the first node among
/// all nodes of the order.
pub fn order(id: &str, update: u32, first: u32, positions: &[f64], released: usize) -> Value {
    let nodes: Vec<Value> =
        positions.iter().enumerate().map(|(i, x)| node(first + i as u32, *x, i < released)).collect();
    let edges: Vec<Value> = (1..positions.len())
        .map(|i| {
            let place = first + i as u32;
            json!({
                "edgeId": format!("e{place}"), "sequenceId": 2 * place - 1, "released": i < released,
                "startNodeId": format!("n{}", place - 1), "endNodeId": format!("n{place}"), "actions": [],
            })
        })
        .collect();
    with_header(json!({ "orderId": id, "orderUpdateId": update, "nodes": nodes, "edges": edges }))
}

fn node(place: u32, x: f64, released: bool) -> Value {
    json!({
        "nodeId": format!("n{place}"), "sequenceId": 2 * place, "released": released, "actions": [],
        "nodePosition": { "x": x, "y": 0.0, "theta": 0.0, "mapId": MAP },
    })
}

/// An action at a node.
pub fn action(id: &str, kind: &str, blocking: &str, parameters: &Value) -> Value {
    json!({ "actionId": id, "actionType": kind, "blockingType": blocking, "actionParameters": parameters })
}

/// Types of the errors of a state.
pub fn errors(state: &Value) -> Vec<&str> {
    state["errors"].as_array().unwrap().iter().map(|error| error["errorType"].as_str().unwrap()).collect()
}

/// Reference of an error of a state under a key.
pub fn reference<'a>(error: &'a Value, key: &str) -> Option<&'a str> {
    let references = error["errorReferences"].as_array()?;
    references.iter().find(|reference| reference["referenceKey"] == key)?["referenceValue"].as_str()
}

/// Status of an action.
pub fn status<'a>(state: &'a Value, id: &str) -> Option<&'a str> {
    let states = state["actionStates"].as_array()?;
    states.iter().find(|action| action["actionId"] == id)?["actionStatus"].as_str()
}

/// Names of the nodes that are left.
pub fn nodes(state: &Value) -> Vec<&str> {
    state["nodeStates"].as_array().unwrap().iter().map(|node| node["nodeId"].as_str().unwrap()).collect()
}
