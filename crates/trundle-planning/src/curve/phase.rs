//! Phases of a route: turns in place and curves.

use crate::curve::analytic_curve::Curve;
use trundle_core::Pose2;

/// One motion without a stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// A turn in place.
    Turn {
        /// Pose before the turn, map frame.
        from: Pose2,
        /// Angle, counter-clockwise, rad; outside +-pi if the shorter turn is blocked.
        angle: f64,
    },
    /// A drive along a curve, forward.
    Drive(Curve),
}
