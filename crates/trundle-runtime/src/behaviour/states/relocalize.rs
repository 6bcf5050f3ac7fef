//! Relocalize: observing the surroundings in search of the pose.

use crate::behaviour::spin::SPIN_RATE_RAD_S;
use crate::behaviour::tools::Tools;
use crate::world_state::WorldState;
use trundle_core::Twist2;

/// Turns on the spot. The gyro's bias is measured at rest.
pub(crate) fn tick(tools: &Tools, s: &WorldState<'_>) -> Twist2 {
    if tools.opening.is_over(s) { Twist2::new(0.0, SPIN_RATE_RAD_S) } else { Twist2::ZERO }
}
