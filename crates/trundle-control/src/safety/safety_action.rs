//! Decision of the safety monitor about a command, and its reason.

use super::hold::MotionHold;
use std::fmt;
use trundle_core::{Twist2, Vector2};

/// Decision of the monitor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SafetyReport {
    /// The twist to send: always safe, always finite.
    pub twist: Twist2,
    /// The change of the command, and its reason.
    pub action: SafetyAction,
}

impl SafetyReport {
    pub(super) fn pass(twist: Twist2) -> Self {
        Self { twist, action: SafetyAction::Pass }
    }

    pub(super) fn stop(reason: StopReason) -> Self {
        Self { twist: Twist2::ZERO, action: SafetyAction::Stop(reason) }
    }

    /// The twist slowed to at most this speed, m/s, on its own curve.
    pub(super) fn slowed(twist: Twist2, speed: f64, reason: SlowReason) -> Self {
        let part = speed / twist.v.abs();
        if part >= 1.0 {
            return Self::pass(twist);
        }
        Self { twist: Twist2::new(twist.v * part, twist.omega * part), action: SafetyAction::Slow(reason) }
    }

    /// The slower of two decisions, this one if both are equal.
    pub(super) fn slower(self, other: Self) -> Self {
        if other.twist.v.abs() < self.twist.v.abs() { other } else { self }
    }
}

/// Decision of the safety monitor about a command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SafetyAction {
    /// The twist passed unchanged.
    Pass,
    /// The twist was slowed along its own curve.
    Slow(SlowReason),
    /// The twist was stopped. In front of an obstacle the robot may still turn on the spot.
    Stop(StopReason),
}

/// Reason why the robot drives slower than commanded.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SlowReason {
    /// An obstacle ahead, still far enough.
    ObstacleAhead {
        /// Path length until contact, m.
        distance: f64,
        /// The obstacle, base frame, m.
        at: Vector2,
    },
    /// An obstacle near a turn on the spot, at a sufficient distance.
    ObstacleBeside {
        /// Angle until contact, rad.
        angle: f64,
        /// The obstacle, base frame, m.
        at: Vector2,
    },
    /// An obstacle close to the side of the path.
    NarrowGap {
        /// The obstacle, base frame, m.
        at: Vector2,
    },
    /// The newest image with content is older than usual.
    OldImage {
        /// Age of the image, s.
        age: f64,
    },
    /// The wheels are commanded while the encoders count nothing.
    WheelsCountNothing,
    /// Driving backward, out of view.
    Reversing,
    /// The bumper is pressed or an edge is below, and the robot backs out.
    BackingOut,
}

/// Reason why the robot was stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum StopReason {
    /// An obstacle nearer than the braking distance.
    ObstacleAhead {
        /// Path length until contact, m.
        distance: f64,
        /// The obstacle, base frame, m.
        at: Vector2,
    },
    /// An obstacle that a turn on the spot would touch.
    ObstacleBeside {
        /// Angle until contact, rad.
        angle: f64,
        /// The obstacle, base frame, m.
        at: Vector2,
    },
    /// The bumper is pressed.
    Touched,
    /// A cliff sensor detects no floor.
    Cliff,
    /// No image, or scan of a laser, has arrived yet.
    NoImage,
    /// Images or scans arrive, but none has had content yet.
    NothingSeen,
    /// The newest image with content, or scan of a laser, is too old.
    StaleImage {
        /// Age of the image, s.
        age: f64,
    },
    /// The wheels are commanded while the encoders count nothing, and no image measures the motion.
    NothingTellsMotion,
    /// No wheel reading has arrived yet.
    NoWheels,
    /// The newest wheel reading is too old.
    StaleWheels {
        /// Age of the reading, s.
        age: f64,
    },
    /// A condition of the body under which no wheel may turn.
    Held(MotionHold),
    /// The command, or the odometry under the scan, is not a number.
    NotFinite,
}

impl fmt::Display for SlowReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ObstacleAhead { distance, .. } => write!(f, "an obstacle {distance:.2} m ahead"),
            Self::ObstacleBeside { angle, .. } => {
                write!(f, "an obstacle after {:.0} deg", angle.to_degrees())
            }
            Self::NarrowGap { at } => write!(f, "a narrow gap, {side}", side = side(*at)),
            Self::OldImage { age } => write!(f, "the newest image that shows something is {age:.2} s old"),
            Self::WheelsCountNothing => {
                f.write_str("the encoders do not count although the wheels are commanded")
            }
            Self::Reversing => f.write_str("backward without a view"),
            Self::BackingOut => f.write_str("backing out of a contact or off an edge"),
        }
    }
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ObstacleAhead { distance, at } => {
                write!(f, "an obstacle in the way, {distance:.2} m to contact, {side}", side = side(*at))
            }
            Self::ObstacleBeside { at, .. } => write!(f, "no room to turn, an obstacle {}", side(*at)),
            Self::Touched => f.write_str("the bumper is pressed"),
            Self::Cliff => f.write_str("there is no floor ahead"),
            Self::NoImage => f.write_str("no image or scan yet"),
            Self::NothingSeen => f.write_str("no image has shown anything yet"),
            Self::StaleImage { age } => {
                write!(f, "the newest image or scan that shows something is {}", Age(*age))
            }
            Self::NothingTellsMotion => {
                write!(f, "{}, and no image measures the motion", SlowReason::WheelsCountNothing)
            }
            Self::NoWheels => f.write_str("no wheel reading yet"),
            Self::StaleWheels { age } => write!(f, "the newest wheel reading is {}", Age(*age)),
            Self::Held(hold) => hold.fmt(f),
            Self::NotFinite => f.write_str("the command is not a number"),
        }
    }
}

/// Age of a reading, s; negative if its stamp is ahead of the clock.
struct Age(f64);

impl fmt::Display for Age {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 < 0.0 {
            write!(f, "stamped {:.2} s ahead of the clock: let both devices use one clock", -self.0)
        } else {
            write!(f, "{:.2} s old", self.0)
        }
    }
}

fn side(at: Vector2) -> String {
    format!("at ({:.2}, {:.2}) m from the base", at.x, at.y)
}

impl fmt::Display for SafetyAction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pass => f.write_str("free"),
            Self::Slow(reason) => write!(f, "slow: {reason}"),
            Self::Stop(reason) => write!(f, "stop: {reason}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_has_its_numbers_in_the_text() {
        let stop = SafetyAction::Stop(StopReason::StaleImage { age: 0.712 });
        assert_eq!(stop.to_string(), "stop: the newest image or scan that shows something is 0.71 s old");
        let slow =
            SafetyAction::Slow(SlowReason::ObstacleAhead { distance: 0.5, at: Vector2::new(1.0, 0.0) });
        assert_eq!(slow.to_string(), "slow: an obstacle 0.50 m ahead");
        let at = Vector2::new(0.31, -0.2);
        let beside = SafetyAction::Stop(StopReason::ObstacleBeside { angle: 0.1, at });
        assert_eq!(beside.to_string(), "stop: no room to turn, an obstacle at (0.31, -0.20) m from the base");
        let now = SafetyAction::Stop(StopReason::StaleWheels { age: 0.0 });
        assert_eq!(now.to_string(), "stop: the newest wheel reading is 0.00 s old");
    }
}
