//! Events of a body other than motion and images: wheel drop, power, docking light, buttons, links.

use crate::{Invalid, Stamp, require_finite, require_in};
use serde::{Deserialize, Serialize};

/// An event of a body other than motion and images.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BodyEvent {
    /// Stamp of the event.
    pub stamp: Stamp,
    /// The event.
    pub kind: BodyEventKind,
}

impl BodyEvent {
    /// An event of this kind.
    pub const fn new(stamp: Stamp, kind: BodyEventKind) -> Self {
        Self { stamp, kind }
    }

    /// The event, its numbers finite and in range.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self, Invalid> {
        if let BodyEventKind::Battery(battery) = self.kind {
            require_finite("battery voltage", battery.voltage_v, "V")?;
            battery.charge.map(|charge| require_in("battery charge", charge, "", 0.0, 1.0)).transpose()?;
        }
        Ok(self)
    }
}

/// Kind of a [`BodyEvent`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum BodyEventKind {
    /// A wheel left the floor or returned to it. The base must not drive while a wheel hangs in the air.
    WheelDrop(PerWheel),
    /// A wheel motor draws too much current, or no longer does.
    OverCurrent(PerWheel),
    /// Voltage and charger.
    Battery(Battery),
    /// The light of a charging station, as three receivers at the front of the base see it.
    DockInfrared(DockInfrared),
    /// A button went down or up.
    Button(Button),
    /// A device of the body was lost, or found again.
    Link(Link),
    /// The body has had no event since the last one. A live body yields it during a longer silence, so that the robot's time advances.
    Silence,
}

/// A state of each wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PerWheel {
    /// State of the left wheel.
    pub left: bool,
    /// State of the right wheel.
    pub right: bool,
}

impl PerWheel {
    /// Whether the state of either wheel is true.
    #[must_use]
    pub fn any(&self) -> bool {
        self.left || self.right
    }
}

/// State of the battery.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Battery {
    /// Voltage \[V\].
    pub voltage_v: f64,
    /// Charge, 0 (empty) to 1 (full); `None` if the body does not measure it.
    pub charge: Option<f64>,
    /// Source of the power.
    pub source: PowerSource,
    /// Whether the battery is being charged.
    pub is_charging: bool,
}

/// Source of a body's power.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PowerSource {
    /// The battery alone.
    #[default]
    Battery,
    /// The contacts of a charging station.
    ChargingStation,
    /// A power adapter, plugged in by a person: the base must not drive.
    Adapter,
}

/// The light of a charging station at three receivers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DockInfrared {
    /// Receiver at the left of the front.
    pub left: DockBeams,
    /// Receiver at the middle of the front.
    pub center: DockBeams,
    /// Receiver at the right of the front.
    pub right: DockBeams,
}

impl DockInfrared {
    /// Whether any receiver detects any sector.
    #[must_use]
    pub fn is_any(&self) -> bool {
        *self != Self::default()
    }
}

/// Beams of a charging station that one receiver detects. Left and right are those of the station, as seen in the direction of its front:
/// the left sector is on the right-hand side of a robot that faces the station. Source: the vendor's dock drive. It turns a robot in the
/// right sector clockwise until its left receiver detects the station, and then drives ahead to the middle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DockBeams {
    /// The left sector, near the station.
    pub near_left: bool,
    /// The middle sector, near the station.
    pub near_center: bool,
    /// The right sector, near the station.
    pub near_right: bool,
    /// The left sector, far from the station.
    pub far_left: bool,
    /// The middle sector, far from the station.
    pub far_center: bool,
    /// The right sector, far from the station.
    pub far_right: bool,
}

/// State of a button.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Button {
    /// Number of the button, from 0.
    pub index: u8,
    /// Whether the button is pressed.
    pub pressed: bool,
}

/// State of the connection to a device of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Link {
    /// The device.
    pub device: Device,
    /// Whether the device responds.
    pub is_up: bool,
}

/// A device of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Device {
    /// The base: wheels, gyro, bumper.
    Base,
    /// The RGB-D camera.
    Camera,
    /// The 2-D laser.
    Laser,
}

impl std::fmt::Display for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Base => "base",
            Self::Camera => "camera",
            Self::Laser => "laser",
        })
    }
}
