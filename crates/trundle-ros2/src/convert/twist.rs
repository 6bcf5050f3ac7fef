//! Twists.

use crate::generated::geometry_msgs::{Twist, TwistStamped, Vector3Message};
use trundle_core::{Invalid, Stamp, Twist2, require_finite};

/// Largest speed of a command \[m/s\], and largest turn rate \[rad/s\]: beyond them a message is broken. Source: ours.
const MAX_COMMAND: f64 = 10.0;

/// The twist of a two-wheeled base: speed ahead and turn rate.
///
/// # Errors
/// When a number is not finite or above 10, or the command contains sideways or vertical motion, or a tilt.
pub fn from_ros(twist: &Twist) -> Result<Twist2, Invalid> {
    let (linear, angular) = (&twist.linear, &twist.angular);
    for (name, value, unit) in [("linear.x", linear.x, "m/s"), ("angular.z", angular.z, "rad/s")] {
        require_finite(name, value, unit)?;
        if value.abs() > MAX_COMMAND {
            return Err(Invalid::new(name, value, unit, "-10 to 10"));
        }
    }
    let others =
        [("linear.y", linear.y), ("linear.z", linear.z), ("angular.x", angular.x), ("angular.y", angular.y)];
    match others.into_iter().find(|(_, value)| *value != 0.0) {
        Some((name, value)) => Err(Invalid::new(name, value, "", "0: the base drives ahead and turns")),
        None => Ok(Twist2::new(linear.x, angular.z)),
    }
}

/// The twist as a message.
#[must_use]
pub fn to_ros(twist: Twist2) -> Twist {
    let axis = |x, z| Vector3Message { x, y: 0.0, z };
    Twist { linear: axis(twist.v, 0.0), angular: axis(0.0, twist.omega) }
}

/// The twist with stamp and frame.
#[must_use]
pub fn stamped(twist: Twist2, stamp: Stamp, frame: &str) -> TwistStamped {
    TwistStamped { header: super::stamp::header(stamp, frame), twist: to_ros(twist) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_that_a_base_cannot_follow_are_refused() {
        let twist = Twist2::new(0.3, -0.7);
        assert_eq!(from_ros(&to_ros(twist)).unwrap(), twist);
        let mut message = to_ros(twist);
        message.linear.x = f64::NAN;
        assert!(from_ros(&message).unwrap_err().to_string().starts_with("linear.x is NaN m/s"));
        message.linear.x = 0.0;
        message.linear.y = f64::NAN;
        assert!(from_ros(&message).unwrap_err().to_string().starts_with("linear.y is NaN"));
        message.linear.y = 0.0;
        message.angular.z = 1e9;
        assert!(from_ros(&message).unwrap_err().to_string().contains("-10 to 10"));
    }
}
