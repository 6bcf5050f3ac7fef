//! Instant actions.

use super::limits::MAX_INSTANT_ACTIONS;
use super::message::{Action, ActionStatus, ErrorReport, InstantActions, OperatingMode, Topic};
use super::node_action::{ActionEnd, NodeAction};
use super::order_check::{check_action, invalid, require_size};
use super::vehicle::Vehicle;
use crate::robot_commands::RobotCommands;
use crate::robot_status::RobotStatus;
use std::time::Duration;
use trundle_core::Pose2;
use trundle_runtime::{MotionHold, OperatorCommand, PoseGuess};

/// Standard deviation of a position that a master gives \[m\]. Source: ours.
const GIVEN_POSITION_SIGMA_M: f64 = 0.2;
/// Standard deviation of a heading that a master gives \[rad\]: 10 deg. Source: ours.
const GIVEN_HEADING_SIGMA_RAD: f64 = 0.175;
/// Speed below which the robot is at rest \[m/s\], and turn rate \[rad/s\]. Source: ours.
const REST_SPEED_M_S: f64 = 0.01;
const REST_RATE_RAD_S: f64 = 0.02;

/// Whether a robot is at rest.
#[must_use]
pub fn is_at_rest(view: &RobotStatus) -> bool {
    let twist = view.estimate.twist;
    twist.v.abs() < REST_SPEED_M_S && twist.omega.abs() < REST_RATE_RAD_S
}

impl Vehicle {
    /// Takes a message of the topic `instantActions`.
    pub fn on_instant_actions(&mut self, payload: &[u8], view: &RobotStatus, robot: &mut dyn RobotCommands) {
        match read(payload) {
            Ok(actions) => actions.into_iter().for_each(|action| self.begin_instant(action, view, robot)),
            Err(error) => self.errors.add(error),
        }
    }

    /// Begins an action; one of a name that is known was sent twice and is ignored.
    fn begin_instant(&mut self, action: Action, view: &RobotStatus, robot: &mut dyn RobotCommands) {
        if self.book.knows_action(&action.action_id) {
            return;
        }
        self.book.add_instant_action(&action);
        let id = action.action_id.clone();
        match self.try_instant(&action, view, robot) {
            Ok(ActionStatus::Running) => {
                self.book.set_status(&id, ActionStatus::Running, None);
                self.pending.push(action);
            }
            Ok(status) => self.book.set_status(&id, status, None),
            Err(error) => self.fail_instant(&action, error),
        }
    }

    fn fail_instant(&mut self, action: &Action, error: ErrorReport) {
        let (id, text) = (&action.action_id, error.error_description.clone());
        self.book.set_status(id, ActionStatus::Failed, Some(text));
        let error = error.about("topic", Topic::InstantActions.name()).about("actionId", id);
        self.errors.add(error.about("actionType", &action.action_type));
    }

    fn try_instant(
        &mut self,
        action: &Action,
        view: &RobotStatus,
        robot: &mut dyn RobotCommands,
    ) -> Result<ActionStatus, ErrorReport> {
        let refused = |text: String| ErrorReport::warning("instantActionError", text);
        let mut send = |command| robot.send(command).map_err(refused);
        match action.action_type.as_str() {
            "cancelOrder" => {
                if !self.book.is_active() {
                    return Err(ErrorReport::warning("noOrderToCancel", "there is no order to cancel"));
                }
                let mission = send(OperatorCommand::cancel())?;
                self.note_own_mission(mission);
                self.begin_cancel();
                Ok(ActionStatus::Running)
            }
            "startPause" => send(OperatorCommand::Pause).map(|_| ActionStatus::Running),
            "stopPause" => send(OperatorCommand::Continue).map(|_| ActionStatus::Running),
            "stateRequest" => {
                self.wants_state = true;
                Ok(ActionStatus::Finished)
            }
            "factsheetRequest" => {
                self.wants_factsheet = true;
                Ok(ActionStatus::Finished)
            }
            "initPosition" => {
                let guess = self.given_pose(action, view).map_err(refused)?;
                send(OperatorCommand::SetPose(guess))?;
                action.text("lastNodeId").iter().for_each(|node_id| self.book.set_last_node(node_id));
                Ok(ActionStatus::Finished)
            }
            "startCharging" => self.begin_charging(action, robot),
            other => Err(refused(format!("this robot cannot do {other} at once"))),
        }
    }

    fn begin_charging(
        &mut self,
        action: &Action,
        robot: &mut dyn RobotCommands,
    ) -> Result<ActionStatus, ErrorReport> {
        let refused = |text: String| ErrorReport::warning("instantActionError", text);
        if self.book.is_active() {
            return Err(refused("an order is in execution: cancel it first".to_owned()));
        }
        let (work, mission) = NodeAction::begin(action.clone(), robot).map_err(refused)?;
        self.charging = Some(work);
        mission.into_iter().for_each(|mission| self.note_own_mission(mission));
        Ok(ActionStatus::Running)
    }

    fn given_pose(&self, action: &Action, view: &RobotStatus) -> Result<PoseGuess, String> {
        let number = |key: &str| {
            action.number(key).ok_or_else(|| format!("initPosition needs the parameter {key}, a number"))
        };
        let pose = Pose2::new(number("x")?, number("y")?, number("theta")?);
        match action.text("mapId") {
            Some(map_id) if map_id == self.map_id => {}
            map_id => {
                let map_id = map_id.unwrap_or_default();
                return Err(format!("mapId is '{map_id}', expected '{}'", self.map_id));
            }
        }
        if !is_at_rest(view) || self.book.is_active() {
            return Err("the robot drives or has an order: stop it first".to_owned());
        }
        let (position_sigma, heading_sigma) = (GIVEN_POSITION_SIGMA_M, GIVEN_HEADING_SIGMA_RAD);
        Ok(PoseGuess { pose, position_sigma, heading_sigma })
    }

    /// Ends the finished actions.
    pub(super) fn follow_instant_actions(&mut self, view: &RobotStatus) {
        let is_paused = view.hold == Some(MotionHold::Paused);
        for action in std::mem::take(&mut self.pending) {
            let is_done = match action.action_type.as_str() {
                "cancelOrder" => is_at_rest(view),
                "startPause" => is_paused && is_at_rest(view),
                "stopPause" => !is_paused,
                _ => self.charging.is_none(),
            };
            if is_done && action.action_type == "cancelOrder" {
                self.book.drop_nodes();
            }
            if is_done && action.action_type != "startCharging" {
                self.book.set_status(&action.action_id, ActionStatus::Finished, None);
            } else if !is_done {
                self.pending.push(action);
            }
        }
    }

    /// Continues the instant action of charging.
    pub(super) fn follow_charging(&mut self, passed: Duration, view: &RobotStatus) {
        let Some(work) = &mut self.charging else { return };
        let end = match work.step(passed, view) {
            ActionEnd::Open if self.mode(view) == OperatingMode::Automatic => return,
            ActionEnd::Open => ActionEnd::Failed("another front end gave the robot another task".to_owned()),
            end => end,
        };
        let Some(work) = self.charging.take() else { return };
        match end {
            ActionEnd::Failed(reason) => {
                self.fail_instant(work.action(), ErrorReport::warning("instantActionError", reason));
            }
            _ => self.book.set_status(&work.action().action_id, ActionStatus::Finished, None),
        }
    }
}

fn read(payload: &[u8]) -> Result<Vec<Action>, ErrorReport> {
    require_size(payload, Topic::InstantActions)?;
    let wrong = |text: String| invalid(text, Topic::InstantActions);
    let message: InstantActions =
        serde_json::from_slice(payload).map_err(|error| wrong(error.to_string()))?;
    let actions = message.actions.len();
    if actions > MAX_INSTANT_ACTIONS {
        return Err(wrong(format!("{actions} actions, expected up to {MAX_INSTANT_ACTIONS}")));
    }
    message.actions.iter().try_for_each(check_action).map_err(wrong)?;
    Ok(message.actions)
}
