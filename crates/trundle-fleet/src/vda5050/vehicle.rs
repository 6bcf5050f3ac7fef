//! A robot of a fleet: carries out orders and instant actions.

use super::drive::{Drive, DriveEnd};
use super::errors::ErrorBook;
use super::message::{Action, BlockingType, ErrorReport, OperatingMode, Order};
use super::node_action::{ActionEnd, NodeAction};
use super::order_book::OrderBook;
use super::order_check::read_order;
use super::order_decision::{OrderDecision, decide, is_within_deviation};
use super::{abilities::require_able, message::ActionStatus};
use crate::robot_commands::RobotCommands;
use crate::robot_facts::RobotFacts;
use crate::robot_status::RobotStatus;
use std::time::Duration;
use trundle_runtime::OperatorCommand;

/// A robot of a fleet.
#[derive(Debug)]
pub struct Vehicle {
    pub(super) facts: RobotFacts,
    pub(super) map_id: String,
    pub(super) book: OrderBook,
    pub(super) errors: ErrorBook,
    drive: Option<Drive>,
    action: Option<NodeAction>,
    /// The instant action of charging.
    pub(super) charging: Option<NodeAction>,
    /// Instant actions that have not ended.
    pub(super) pending: Vec<Action>,
    /// Number of the last mission started for the master, or of the one that ran when the order came.
    own_mission: u64,
    /// Speed limit that was sent \[m/s\].
    speed: f64,
    pub(super) wants_state: bool,
    pub(super) wants_factsheet: bool,
}

impl Vehicle {
    /// A robot that has the map `map_id`.
    #[must_use]
    pub fn new(facts: RobotFacts, map_id: &str) -> Self {
        let speed = facts.limits.v;
        Self {
            facts,
            map_id: map_id.to_owned(),
            book: OrderBook::default(),
            errors: ErrorBook::default(),
            drive: None,
            action: None,
            charging: None,
            pending: Vec::new(),
            own_mission: 0,
            speed,
            wants_state: false,
            wants_factsheet: false,
        }
    }

    /// Whether a master requested the state since the last call.
    pub fn take_state_wish(&mut self) -> bool {
        std::mem::take(&mut self.wants_state)
    }

    /// Whether a master requested the factsheet since the last call.
    pub fn take_factsheet_wish(&mut self) -> bool {
        std::mem::take(&mut self.wants_factsheet)
    }

    /// Takes a message of the topic `order`.
    pub fn on_order(&mut self, payload: &[u8], view: &RobotStatus) {
        let order = match read_order(payload) {
            Ok(order) => order,
            Err(error) => return self.errors.add(error),
        };
        let (order_id, update_id) = (order.order_id.clone(), order.order_update_id);
        if let Err(error) = self.accept(order, view) {
            let error = error.about("topic", "order").about("orderId", order_id);
            self.errors.add(error.about("orderUpdateId", update_id));
        }
    }

    fn accept(&mut self, order: Order, view: &RobotStatus) -> Result<(), ErrorReport> {
        let decision = decide(&order, &self.book, view.estimate.pose)?;
        if decision == OrderDecision::Discard {
            return Ok(());
        }
        self.require_free(view)?;
        require_able(&order, &self.facts, &self.map_id)?;
        self.errors.clear();
        self.note_own_mission(view.mission.id);
        if decision == OrderDecision::New {
            self.book.begin(order);
        } else {
            self.book.extend(order);
        }
        Ok(())
    }

    /// A robot that is being cancelled or driven by a person accepts no order.
    fn require_free(&self, view: &RobotStatus) -> Result<(), ErrorReport> {
        if self.is_cancelling() {
            return Err(ErrorReport::warning("orderError", "the present order is being cancelled"));
        }
        match self.mode(view) {
            OperatingMode::Automatic => Ok(()),
            OperatingMode::Manual => {
                let text = "a person or another program gave the robot a task, which is not done";
                Err(ErrorReport::warning("orderError", text).about("operatingMode", "MANUAL"))
            }
        }
    }

    /// Whether the robot stops for a cancelled order.
    fn is_cancelling(&self) -> bool {
        self.pending.iter().any(|action| action.action_type == "cancelOrder")
    }

    /// Notes the number of a mission that the master is the reason of.
    pub(super) fn note_own_mission(&mut self, mission: u64) {
        self.own_mission = self.own_mission.max(mission);
    }

    /// Controller of the robot: a person if another front end gave the present mission.
    #[must_use]
    pub fn mode(&self, view: &RobotStatus) -> OperatingMode {
        let is_foreign = view.mission.id > self.own_mission;
        let is_open = view.mission.task.is_some() && !view.mission.is_over;
        if is_foreign && is_open { OperatingMode::Manual } else { OperatingMode::Automatic }
    }

    /// Whether the robot still follows a mission of the master, or its initial mission.
    fn is_under_way(&self, view: &RobotStatus) -> bool {
        view.mission.id != self.own_mission || (view.mission.task.is_some() && !view.mission.is_over)
    }

    /// Continues the order and the instant actions, `passed` after the last step.
    pub fn step(&mut self, passed: Duration, view: &RobotStatus, robot: &mut dyn RobotCommands) {
        if self.book.is_active() && view.mission.id > self.own_mission {
            self.abort();
        }
        self.follow_action(passed, view, robot);
        self.follow_drive(passed, view);
        if self.may_drive() {
            self.drive_on(view, robot);
        }
        self.follow_charging(passed, view);
        self.follow_instant_actions(view);
    }

    /// Another front end took the robot over.
    fn abort(&mut self) {
        let (order_id, update_id) = (self.book.order_id().to_owned(), self.book.update_id());
        self.drop_order();
        let text = "a person or another program gave the robot another task: the order is dropped";
        let error = ErrorReport::warning("orderAborted", text).about("topic", "order");
        self.errors.add(error.about("orderId", order_id).about("orderUpdateId", update_id));
    }

    /// Ends the drive and the actions of the order. Its nodes remain until the robot is at rest.
    pub(super) fn begin_cancel(&mut self) {
        (self.drive, self.action) = (None, None);
        self.errors.remove("driveError");
        self.book.fail_actions();
    }

    /// Drops the rest of the order.
    pub(super) fn drop_order(&mut self) {
        self.begin_cancel();
        self.book.drop_nodes();
    }

    /// The action at the last node, and the next one when it has ended.
    fn follow_action(&mut self, passed: Duration, view: &RobotStatus, robot: &mut dyn RobotCommands) {
        if let Some(action) = &mut self.action {
            match action.step(passed, view) {
                ActionEnd::Open => return,
                ActionEnd::Done => self.end_action(ActionStatus::Finished, None),
                ActionEnd::Failed(reason) => self.end_action(ActionStatus::Failed, Some(reason)),
            }
        }
        let needs_rest = self.book.next_action().is_some_and(NodeAction::drives);
        if needs_rest && self.drive.is_some() {
            return;
        }
        if let Some(action) = self.book.take_action() {
            self.begin_action(action, robot);
        }
    }

    fn begin_action(&mut self, action: Action, robot: &mut dyn RobotCommands) {
        let id = action.action_id.clone();
        match NodeAction::begin(action, robot) {
            Ok((action, mission)) => {
                mission.into_iter().for_each(|mission| self.note_own_mission(mission));
                self.book.set_status(&id, ActionStatus::Running, None);
                self.action = Some(action);
            }
            Err(reason) => self.book.set_status(&id, ActionStatus::Failed, Some(reason)),
        }
    }

    fn end_action(&mut self, status: ActionStatus, reason: Option<String>) {
        let Some(action) = self.action.take() else { return };
        let id = &action.action().action_id;
        if let Some(reason) = &reason {
            let error = ErrorReport::warning("orderActionError", reason.clone()).about("topic", "order");
            self.errors.add(error.about("orderId", self.book.order_id()).about("actionId", id));
        }
        self.book.set_status(id, status, reason);
    }

    fn follow_drive(&mut self, passed: Duration, view: &RobotStatus) {
        let Some(drive) = &mut self.drive else { return };
        let rolls_on =
            !self.book.is_at_end_of_base()
                && self.book.nodes().front().is_some_and(|node| {
                    node.actions.is_empty() && is_within_deviation(node, view.estimate.pose)
                });
        let end = drive.step(passed, view);
        let is_due_again = drive.is_due_again();
        match end {
            _ if rolls_on => self.reach(),
            DriveEnd::Open if is_due_again => self.drive = None,
            DriveEnd::Open => {}
            DriveEnd::Arrived => self.reach(),
            DriveEnd::Failed(reason) => self.report_obstruction(&reason),
        }
    }

    fn reach(&mut self) {
        self.drive = None;
        self.errors.remove("driveError");
        self.book.reach();
    }

    /// Reports that the robot did not reach a node; the next attempt follows after a pause.
    fn report_obstruction(&mut self, reason: &str) {
        let node = self.book.nodes().front().map(|node| node.node_id.clone()).unwrap_or_default();
        let text = format!("node {node} was not reached: {reason}");
        let error = ErrorReport::warning("driveError", text).about("topic", "order").about("nodeId", node);
        let error = error.hint("clear the path or cancel the order; the robot tries again every 10 s");
        self.errors.replace(error.about("orderId", self.book.order_id()));
    }

    fn may_drive(&self) -> bool {
        let blocks =
            |action: &Action| action.blocking_type != BlockingType::None || NodeAction::drives(action);
        let present = self.action.as_ref().map(NodeAction::action);
        self.drive.is_none()
            && !self.is_cancelling()
            && !present.into_iter().chain(self.book.next_action()).any(blocks)
    }

    /// Starts the drive to the next node of the base; a node that is already reached ends immediately.
    fn drive_on(&mut self, view: &RobotStatus, robot: &mut dyn RobotCommands) {
        let Some((node, edge)) = self.book.next_stop() else { return };
        if !self.is_under_way(view) && is_within_deviation(node, view.estimate.pose) {
            return self.reach();
        }
        let limit = edge.and_then(|edge| edge.max_speed).unwrap_or(f64::MAX).min(self.facts.limits.v);
        if (limit - self.speed).abs() > f64::EPSILON
            && robot.send(OperatorCommand::Change(trundle_runtime::RunSetting::Speed(limit))).is_ok()
        {
            self.speed = limit;
        }
        let drive = Drive::begin(node, view.estimate.pose, robot);
        match drive {
            Ok(drive) => {
                self.note_own_mission(drive.mission());
                self.drive = Some(drive);
            }
            Err(reason) => tracing::debug!("VDA 5050: {reason}"),
        }
    }
}
