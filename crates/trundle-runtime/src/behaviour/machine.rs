//! The state machine: the parts of a control step in each state, and the one place where the state changes.
//!
//! A control step has four parts. A part may ask for a change of state; the next part belongs to the new state.
//!
//! | part | what the state decides |
//! |---|---|
//! | plan | whether a plan is due, and the reaction to its result |
//! | follow | the reaction to the path follower's phase |
//! | tick | the twist |
//! | safety | the reaction to the safety monitor's decision about the twist |

use super::path_search::PathSearch;
use super::state::{Change, Next, State};
use super::states::{approach, drive, initialize, maneuver, plan, relocalize, spin_once};
use super::tools::Tools;
use super::transitions::is_allowed;
use crate::reason::{Reason, TransitionReason};
use crate::stage::StageTimes;
use crate::world_state::WorldState;
use trundle_control::{FollowReport, SafetyAction, StationMotion};
use trundle_core::Twist2;

/// Holds the state. Each change of state passes through [`StateMachine::change`].
#[derive(Debug, Default)]
pub(crate) struct StateMachine {
    state: State,
    /// Reason for the last change of state.
    reason: Option<TransitionReason>,
}

impl StateMachine {
    /// The present state.
    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    /// Reason for the last change of state; `None` before the first one.
    pub(crate) fn reason(&self) -> Option<TransitionReason> {
        self.reason
    }

    /// Changes the state, if a change is requested. A change that the table of transitions lacks is an error of this program: it is logged,
    /// and a debug build stops.
    pub(crate) fn change(&mut self, next: Next) {
        let Some(Change { to, reason }) = next else { return };
        let (from, into) = (self.state.kind(), to.kind());
        let is_known = is_allowed(from, reason, into);
        if !is_known {
            tracing::error!("state change {from:?} -> {into:?}, {reason:?}: not in the table of transitions");
        }
        debug_assert!(is_known, "invariant: {from:?} -> {into:?}, {reason:?} is in the table of transitions");
        if from != into {
            tracing::debug!("state change {from:?} -> {into:?}: {reason}");
            self.reason = Some(reason);
        }
        self.state = to;
    }

    /// Before the step: the end of the opening.
    pub(crate) fn prepare(&mut self, tools: &mut Tools, s: &WorldState<'_>) {
        if matches!(self.state, State::Initialize) {
            self.change(initialize::prepare(tools, s));
        }
    }

    /// Plans, if a plan is due; returns whether a new plan exists.
    pub(crate) fn plan(&mut self, tools: &mut Tools, s: &WorldState<'_>, times: &mut StageTimes) -> bool {
        let planned = match &mut self.state {
            State::Plan(search) => plan::plan(search, tools, s, times),
            State::Drive(drive) => drive.plan(tools, s, times),
            State::Wait(wait) => wait.plan(tools, s, times),
            State::Recover(recover) => recover.plan(tools, s, times),
            _ => return false,
        };
        self.change(planned.next);
        planned.is_new || matches!(self.state, State::Drive(_)) && drive::improve(tools, s, times)
    }

    /// Reacts to the path follower's report.
    pub(crate) fn follow(
        &mut self,
        tools: &mut Tools,
        follow: &FollowReport,
        s: &WorldState<'_>,
        times: &mut StageTimes,
    ) {
        let next = match &mut self.state {
            State::Drive(drive) => drive.on_follow(tools, follow, s, times),
            State::Approach => approach::on_follow(tools, follow, s, times),
            State::Wait(wait) => wait.on_follow(tools, follow, s),
            State::Recover(recover) => recover.on_follow(tools, follow, s),
            _ => None,
        };
        self.change(next);
    }

    /// The twist before the check of the safety monitor.
    pub(crate) fn tick(
        &mut self,
        tools: &mut Tools,
        follow: &FollowReport,
        s: &WorldState<'_>,
        times: &mut StageTimes,
    ) -> Twist2 {
        let (twist, next) = match &mut self.state {
            State::Spin(spin) => spin_once::tick(spin, tools, s),
            State::Approach => approach::tick(tools, follow),
            State::Face(heading) => approach::face(*heading, tools, s),
            State::Confirm(confirm) => confirm.tick(tools, s),
            State::Maneuver => maneuver::tick(tools, s, times),
            State::Relative(relative) => relative.tick(tools, s),
            State::Station(station) => station.tick(tools, s),
            State::Wait(wait) => wait.tick(tools, follow, s),
            State::Recover(recover) => recover.tick(follow, s),
            State::Relocalize { .. } => (relocalize::tick(tools, s), None),
            State::Idle | State::Initialize | State::Plan(_) | State::Drive(_) => (follow.twist, None),
            State::Arrived | State::Stopped { .. } => (follow.twist, None),
        };
        self.change(next);
        twist
    }

    /// Reacts to the safety monitor's decision about the `wanted` twist.
    pub(crate) fn on_safety(
        &mut self,
        tools: &mut Tools,
        wanted: Twist2,
        action: SafetyAction,
        s: &WorldState<'_>,
    ) {
        let next = match (&mut self.state, action) {
            (State::Relative(relative), action) => relative.on_safety(action, s),
            (State::Wait(wait), action) => wait.on_safety(tools, action, s),
            (State::Drive(drive), SafetyAction::Stop(stop)) => drive.on_stop(tools, wanted, stop, s),
            (State::Approach | State::Face(_), SafetyAction::Stop(stop)) => {
                approach::on_stop(tools, wanted, stop, s)
            }
            (State::Recover(recover), SafetyAction::Stop(stop)) => recover.on_stop(tools, stop, s),
            (State::Maneuver, SafetyAction::Stop(_)) => maneuver::on_stop(tools, wanted, s),
            _ => None,
        };
        self.change(next);
    }

    /// The motion at a charging station that the safety monitor shall permit.
    pub(crate) fn permission(&self, s: &WorldState<'_>) -> Option<StationMotion> {
        match &self.state {
            State::Station(station) => station.permission(s),
            _ => None,
        }
    }

    /// The search for a path, in a state that waits or recovers without a path.
    pub(crate) fn search(&mut self) -> Option<&mut PathSearch> {
        match &mut self.state {
            State::Recover(recover) => Some(&mut recover.search),
            State::Wait(wait) if wait.interrupted.is_none() => Some(&mut wait.search),
            _ => None,
        }
    }

    /// Ends the goal, with a reason.
    pub(crate) fn stop(&mut self, reason: Reason, why: TransitionReason) {
        self.change(State::Stopped { reason }.because(why));
    }

    /// Sets a state for a test.
    #[cfg(test)]
    pub(crate) fn place(&mut self, state: State) {
        self.state = state;
    }

    /// The present state for a test.
    #[cfg(test)]
    pub(crate) fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }
}
