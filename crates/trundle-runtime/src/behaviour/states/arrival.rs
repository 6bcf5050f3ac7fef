//! Confirm: at the goal by an uncertain pose, the robot turns on the spot to observe its surroundings.

use crate::behaviour::goal::Goal;
use crate::behaviour::path_search::PathSearch;
use crate::behaviour::spin::{SPIN_TURNS, Spin};
use crate::behaviour::state::{Confirm, Next, State};
use crate::behaviour::tools::Tools;
use crate::reason::{Reason, TransitionReason};
use crate::world_state::WorldState;
use trundle_core::{PoseBound, Twist2};

/// Number of turns on the spot at one goal. After the last one an uncertain arrival ends the goal. Source: ours.
const MAX_CONFIRMATIONS: u32 = 2;
/// Share of the goal's bound below which an observation ends: the drive that follows makes the pose less certain. Source: ours.
const CONFIRMED_SHARE: f64 = 0.8;

/// At the goal by the estimate: the arrival, or a turn on the spot if the pose is too uncertain for the goal.
pub(crate) fn arrive(tools: &mut Tools, s: &WorldState<'_>) -> Next {
    let Some(reason) = doubt(tools, s, 1.0) else {
        return State::Arrived.because(TransitionReason::GoalReached);
    };
    tools.halt();
    if tools.arrival.confirmations >= MAX_CONFIRMATIONS {
        return State::Stopped { reason }.because(TransitionReason::ArrivalUncertain);
    }
    tools.arrival.confirmations += 1;
    State::Confirm(Confirm { reason, spin: Spin::default() }).because(TransitionReason::ArrivalUncertain)
}

impl Confirm {
    /// A command of the turn. It ends when the pose is certain, or after a complete turn.
    pub(crate) fn tick(&mut self, tools: &Tools, s: &WorldState<'_>) -> (Twist2, Next) {
        if s.hold.is_some() {
            return (Twist2::ZERO, None);
        }
        let Some(reason) = doubt(tools, s, CONFIRMED_SHARE) else {
            return (
                Twist2::ZERO,
                State::Plan(PathSearch::default()).because(TransitionReason::PoseConfirmed),
            );
        };
        if self.spin.has_turned(SPIN_TURNS) {
            return (Twist2::ZERO, State::Stopped { reason }.because(TransitionReason::ArrivalUncertain));
        }
        self.reason = reason;
        (self.spin.twist(s.estimate.pose), None)
    }
}

/// The doubt about an arrival: scans contradict the pose, or its bound is above this share of the goal's. A viewpoint and a relative motion
/// need no certain pose.
fn doubt(tools: &Tools, s: &WorldState<'_>, share: f64) -> Option<Reason> {
    if !matches!(tools.goal, Goal::Exact(_)) {
        return None;
    }
    if s.pose_status.is_contradicted {
        return Some(Reason::ArrivalContradicted);
    }
    let (bound, allowed) = (s.estimate.bound_95(), allowed(tools));
    let is_certain = bound.distance <= share * allowed.distance && bound.heading <= share * allowed.heading;
    (!is_certain).then_some(Reason::ArrivalUncertain { bound, allowed })
}

/// The bound of the pose that the goal demands: its own tolerance, if that is wider than the demand on an exact goal.
fn allowed(tools: &Tools) -> PoseBound {
    let (options, exact) = (&tools.options, tools.arrival.bound);
    let distance = options.tolerance.map_or(exact.distance, |tolerance| tolerance.max(exact.distance));
    let any_heading = options.tolerance.is_some() && options.heading_tolerance.is_none();
    let heading = options.heading_tolerance.map_or(exact.heading, |tolerance| tolerance.max(exact.heading));
    PoseBound { distance, heading: if any_heading { f64::INFINITY } else { heading } }
}
