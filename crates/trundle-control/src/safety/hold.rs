//! Conditions of the body under which no wheel may turn.

use std::fmt;
use trundle_core::Device;

/// A condition of the body under which no wheel may turn. The hold ends with the report of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MotionHold {
    /// A wheel hangs in the air: the robot was lifted, or is at an edge.
    WheelDrop,
    /// A wheel motor exceeds its current limit: the wheel is blocked.
    OverCurrent,
    /// A power supply is plugged in: the robot would tear its cable.
    AdapterConnected,
    /// A device that the robot drives by does not answer.
    DeviceLost(Device),
    /// The battery is empty.
    BatteryEmpty,
    /// A person paused the robot.
    Paused,
    /// The link by which others give and cancel goals has died.
    GoalLinkLost,
}

impl fmt::Display for MotionHold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WheelDrop => f.write_str("a wheel hangs: put the robot on the floor"),
            Self::OverCurrent => f.write_str("a wheel motor draws too much current: free the wheel"),
            Self::AdapterConnected => f.write_str("the power supply is plugged in: unplug it"),
            Self::DeviceLost(device) => write!(f, "the {device} does not answer: check its cable and power"),
            Self::BatteryEmpty => f.write_str("the battery is empty: charge it"),
            Self::Paused => {
                f.write_str("paused by a person: the button or the command that paused it lets it go on")
            }
            Self::GoalLinkLost => f.write_str(
                "the link by which goals came has died, so nobody could cancel one: start the program anew",
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_hold_has_a_remedy_in_its_text() {
        let holds = [
            (MotionHold::WheelDrop, "put the robot on the floor"),
            (MotionHold::OverCurrent, "free the wheel"),
            (MotionHold::AdapterConnected, "unplug"),
            (MotionHold::DeviceLost(Device::Camera), "the camera does not answer"),
            (MotionHold::BatteryEmpty, "charge"),
            (MotionHold::Paused, "paused by a person"),
            (MotionHold::GoalLinkLost, "start the program anew"),
        ];
        for (hold, remedy) in holds {
            assert!(hold.to_string().contains(remedy), "{hold}");
        }
    }
}
