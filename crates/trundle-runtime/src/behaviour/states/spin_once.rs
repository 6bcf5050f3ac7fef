//! Spin: one turn on the spot that observes the surroundings.

use crate::behaviour::spin::{SPIN_TURNS, Spin};
use crate::behaviour::state::{Next, State};
use crate::behaviour::tools::Tools;
use crate::reason::TransitionReason;
use crate::world_state::WorldState;
use trundle_core::Twist2;

/// A command of the full turn.
pub(crate) fn tick(spin: &mut Spin, tools: &Tools, s: &WorldState<'_>) -> (Twist2, Next) {
    if !tools.opening.is_over(s) {
        return (Twist2::ZERO, None);
    }
    if spin.has_turned(SPIN_TURNS) {
        return (Twist2::ZERO, State::Arrived.because(TransitionReason::GoalReached));
    }
    (spin.twist(s.estimate.pose), None)
}
