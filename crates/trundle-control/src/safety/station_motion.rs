//! Motion at a charging station: what the safety monitor permits there and nowhere else.

use trundle_core::{Pose2, Twist2, Vector2};

/// Highest speed of a permitted motion \[m/s\]. Source: ours.
const MAX_SPEED_M_S: f64 = 0.1;
/// Highest turn rate of a permitted motion \[rad/s\]: it holds the heading and does not turn. Source: ours.
const MAX_TURN_RATE_RAD_S: f64 = 0.12;
/// Outline of a station: depth and half of the width \[m\]. Source: ours, the size of the Kobuki's station.
const STATION_DEPTH_M: f64 = 0.1;
const STATION_HALF_WIDTH_M: f64 = 0.13;
/// Margin about the outline within which an obstacle belongs to the station \[m\]: a cell of the map. Source: ours.
const OUTLINE_MARGIN_M: f64 = 0.05;

/// A straight motion at a charging station. Contact with the station is intended, and the camera may be too near to measure anything: the
/// monitor then ignores the station as an obstacle and the age of the newest image. All else holds: other obstacles, bumper, cliffs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StationMotion {
    /// Ahead onto the station.
    Docking {
        /// The station in the base frame: the middle of its front, x out of the front.
        base_from_station: Pose2,
    },
    /// Back off the station, over the floor that the robot came over.
    Undocking,
}

impl StationMotion {
    /// Whether a twist is such a motion: slow, straight, in its direction.
    pub(super) fn permits(&self, twist: Twist2) -> bool {
        let ahead = match self {
            Self::Docking { .. } => twist.v,
            Self::Undocking => -twist.v,
        };
        ahead > 0.0 && ahead <= MAX_SPEED_M_S && twist.omega.abs() <= MAX_TURN_RATE_RAD_S
    }

    /// Whether an obstacle (base frame, m) belongs to the station.
    pub(super) fn is_station(&self, obstacle: Vector2) -> bool {
        let Self::Docking { base_from_station } = self else { return false };
        let at = base_from_station.inverse().transform(obstacle);
        at.x <= OUTLINE_MARGIN_M
            && at.x >= -STATION_DEPTH_M - OUTLINE_MARGIN_M
            && at.y.abs() <= STATION_HALF_WIDTH_M + OUTLINE_MARGIN_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn docking() -> StationMotion {
        StationMotion::Docking { base_from_station: Pose2::new(0.3, 0.0, PI) }
    }

    #[test]
    fn only_slow_straight_motion_in_the_direction_is_permitted() {
        let permits = |motion: StationMotion, v, omega| motion.permits(Twist2::new(v, omega));
        assert!(permits(docking(), 0.05, 0.1) && permits(docking(), 0.1, 0.0));
        for (v, omega) in [(0.11, 0.0), (-0.05, 0.0), (0.05, 0.13), (0.0, 0.1), (f64::NAN, 0.0)] {
            assert!(!permits(docking(), v, omega), "{v} {omega}");
        }
        assert!(
            permits(StationMotion::Undocking, -0.1, 0.0) && !permits(StationMotion::Undocking, 0.05, 0.0)
        );
    }

    #[test]
    fn only_what_is_in_the_outline_belongs_to_the_station() {
        let is_station = |x, y| docking().is_station(Vector2::new(x, y));
        assert!(is_station(0.3, 0.0) && is_station(0.4, 0.15) && is_station(0.26, -0.1));
        assert!(!is_station(0.22, 0.0), "before it");
        assert!(!is_station(0.3, 0.2), "beside it");
        assert!(!is_station(0.5, 0.0), "behind it");
        assert!(!StationMotion::Undocking.is_station(Vector2::new(0.3, 0.0)));
    }
}
