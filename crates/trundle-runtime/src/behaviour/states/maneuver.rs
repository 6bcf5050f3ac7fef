//! Maneuver: turns and straight moves onto the exact goal.

use super::arrival;
use crate::behaviour::goal::Goal;
use crate::behaviour::state::{Next, State};
use crate::behaviour::tools::Tools;
use crate::goal_approach::Progress;
use crate::reason::{Reason, TransitionReason};
use crate::stage::{Stage, StageTimes};
use crate::world_state::WorldState;
use trundle_core::{Pose2, Twist2};

/// Speed below which the robot counts as at rest \[m/s\]. Source: ours.
pub(crate) const STANDING_SPEED_M_S: f64 = 0.02;

/// Begins the manoeuvre that the goal approach has chosen.
pub(crate) fn begin(tools: &mut Tools) -> Next {
    tools.follower.halt();
    State::Maneuver.because(TransitionReason::ManeuverChosen)
}

/// Begins a manoeuvre near the goal, if no path is found or the safety monitor stops the robot.
pub(super) fn begin_if_possible(tools: &mut Tools, goal: Pose2, s: &WorldState<'_>) -> Next {
    let stands = s.estimate.twist.v.abs() < STANDING_SPEED_M_S;
    let may = matches!(tools.goal, Goal::Exact(_)) && stands && !tools.view_monitor.is_blind(s);
    if may && tools.goal_approach.begin_if_possible(s, goal) { begin(tools) } else { None }
}

/// One step of turns and straight moves.
pub(crate) fn tick(tools: &mut Tools, s: &WorldState<'_>, times: &mut StageTimes) -> (Twist2, Next) {
    if tools.view_monitor.is_blind(s) {
        return (tools.view_monitor.recover(None, s), None);
    }
    match times.measure(Stage::Control, || tools.goal_approach.step(s)) {
        Progress::Moving(twist) => {
            tools.view_monitor.held(twist);
            (twist, None)
        }
        Progress::Settled => (Twist2::ZERO, arrival::arrive(tools, s)),
        Progress::GivenUp(failure) => {
            let reason = Reason::FinalApproach(failure);
            (Twist2::ZERO, State::Stopped { reason }.because(TransitionReason::MotionFailed))
        }
    }
}

/// The safety monitor stopped the motion.
pub(crate) fn on_stop(tools: &mut Tools, wanted: Twist2, s: &WorldState<'_>) -> Next {
    if wanted != Twist2::ZERO && !tools.view_monitor.is_blind(s) {
        tools.goal_approach.interrupted(s);
    }
    None
}
