//! Motion at a charging station: the exceptions of the safety monitor there.

use trundle_core::{Pose2, Twist2, Vector2};

/// Highest speed of a permitted motion \[m/s\]. Source: ours.
const MAX_SPEED_M_S: f64 = 0.1;
/// Highest turn rate of a permitted motion \[rad/s\]: enough to keep the heading, too little for a turn. Source: ours.
const MAX_TURN_RATE_RAD_S: f64 = 0.12;
/// Outline of a station: depth and half of the width \[m\]. Source: ours, the size of the Kobuki's station.
const STATION_DEPTH_M: f64 = 0.1;
const STATION_HALF_WIDTH_M: f64 = 0.13;
/// Largest error of the station's distance that is permitted \[m\]. Source: ours.
const MAX_DISTANCE_ERROR_M: f64 = 0.2;
/// Margin about the outline within which an obstacle belongs to the station \[m\]: a cell of the map. Source: ours.
const OUTLINE_MARGIN_M: f64 = 0.05;

/// A straight motion at a charging station. Contact with the station is intended, and the camera may be too near for measurements. The
/// monitor then ignores the station as an obstacle and the age of the newest image. All other checks apply: other obstacles, bumper,
/// cliffs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StationMotion {
    /// Ahead onto the station.
    Docking {
        /// The station in the base frame: the middle of its front, x out of the front.
        base_from_station: Pose2,
        /// Largest error of the station's distance along its axis, m, up to 0.2.
        distance_error: f64,
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
        let Self::Docking { base_from_station, distance_error } = self else { return false };
        let at = base_from_station.inverse().transform(obstacle);
        let along = OUTLINE_MARGIN_M + distance_error.clamp(0.0, MAX_DISTANCE_ERROR_M);
        at.x <= along
            && at.x >= -STATION_DEPTH_M - along
            && at.y.abs() <= STATION_HALF_WIDTH_M + OUTLINE_MARGIN_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn docking() -> StationMotion {
        StationMotion::Docking { base_from_station: Pose2::new(0.3, 0.0, PI), distance_error: 0.0 }
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
        let base_from_station = Pose2::new(0.3, 0.0, PI);
        let uncertain = |distance_error| StationMotion::Docking { base_from_station, distance_error };
        assert!(uncertain(0.1).is_station(Vector2::new(0.5, 0.0)));
        assert!(!uncertain(9.0).is_station(Vector2::new(0.7, 0.0)), "no error makes it larger than that");
        assert!(!StationMotion::Undocking.is_station(Vector2::new(0.3, 0.0)));
    }
}
