//! Distance and heading error of the robot at its goal pose.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, difference_of_angles};

/// Error of the robot's pose at its goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GoalError {
    /// Reached minus goal along the map's x, m.
    pub dx: f64,
    /// Reached minus goal along the map's y, m.
    pub dy: f64,
    /// Distance between the two positions, m.
    pub distance: f64,
    /// Reached minus goal heading by the shorter turn, rad, in (-pi, pi].
    pub dtheta: f64,
}

/// The error at the goal: the reached pose (`reached`) against the goal, both `map_from_base`.
///
/// # Errors
/// When a pose is not finite.
pub fn goal_error(goal: Pose2, reached: Pose2) -> Result<GoalError, Invalid> {
    for (name, pose) in [("goal", goal), ("reached pose", reached)] {
        if !pose.is_finite() {
            let value = format!("({}, {}, {})", pose.x, pose.y, pose.theta);
            return Err(Invalid::new(name, value, "m, m, rad", "finite numbers"));
        }
    }
    Ok(GoalError {
        dx: reached.x - goal.x,
        dy: reached.y - goal.y,
        distance: reached.distance(&goal),
        dtheta: difference_of_angles(reached.theta, goal.theta),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_signed_and_takes_the_shorter_turn() {
        let error = goal_error(Pose2::new(1.0, 2.0, 3.1), Pose2::new(1.3, 1.6, -3.1)).unwrap();
        assert!((error.dx - 0.3).abs() < 1e-12 && (error.dy + 0.4).abs() < 1e-12);
        assert!((error.distance - 0.5).abs() < 1e-12);
        assert!((error.dtheta - (std::f64::consts::TAU - 6.2)).abs() < 1e-12);
        assert!(goal_error(Pose2 { x: f64::NAN, ..Pose2::IDENTITY }, Pose2::IDENTITY).is_err());
    }
}
