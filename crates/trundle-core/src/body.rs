//! The trait of a robot's body, and the sensor events that a body yields.

use crate::{BodyEvent, GyroRate, Odometry, Pose2, RgbdImage, Scan, Stamp, Twist2, WheelTicks};
use serde::{Deserialize, Serialize};

/// State of the bumper: pressed by an obstacle, or free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Touch {
    /// Time of the change.
    pub stamp: Stamp,
    /// Whether the bumper is pressed.
    pub pressed: bool,
}

/// State of the cliff sensors: an edge ahead, or floor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cliff {
    /// Time of the change.
    pub stamp: Stamp,
    /// Whether a cliff sensor detects no floor.
    pub over_edge: bool,
}

/// An event of a robot's body. A body yields events in the order of their stamps.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SensorEvent {
    /// Wheel encoders.
    Wheels(WheelTicks),
    /// Gyro.
    Gyro(GyroRate),
    /// Camera.
    Rgbd(RgbdImage),
    /// Bumper.
    Touch(Touch),
    /// Cliff sensors.
    Cliff(Cliff),
    /// A 2-D laser's sweep.
    Scan(Scan),
    /// Odometry that the body computes itself, with its covariance. A body yields it instead of wheels and gyro.
    Odometry(Odometry),
    /// Power, wheel drop, buttons, links, silence.
    Body(BodyEvent),
    /// Ground truth, `world_from_base`, for evaluation only; the robot must not use it.
    Truth {
        /// Time of the pose.
        stamp: Stamp,
        /// `world_from_base`.
        pose: Pose2,
    },
}

impl SensorEvent {
    /// Stamp of the event.
    pub fn stamp(&self) -> Stamp {
        match self {
            Self::Wheels(wheels) => wheels.stamp,
            Self::Gyro(gyro) => gyro.stamp,
            Self::Rgbd(image) => image.stamp(),
            Self::Touch(touch) => touch.stamp,
            Self::Cliff(cliff) => cliff.stamp,
            Self::Scan(scan) => scan.stamp(),
            Self::Odometry(odometry) => odometry.stamp,
            Self::Body(event) => event.stamp,
            Self::Truth { stamp, .. } => *stamp,
        }
    }
}

/// The interface to a robot's sensors and base: a simulator, a recording, or hardware.
pub trait RobotBody {
    /// Error of the sensors or of the connection.
    type Error: std::error::Error;

    /// The next sensor event; `None` at the end.
    ///
    /// A live body has no end. It waits a tenth of a second at most, then yields [`crate::BodyEventKind::Silence`].
    ///
    /// # Errors
    /// When a sensor or the connection to it failed permanently.
    fn next_event(&mut self) -> Result<Option<SensorEvent>, Self::Error>;

    /// Commands the base to move with `twist` until the next command.
    ///
    /// # Errors
    /// When the base cannot be reached.
    fn command(&mut self, twist: Twist2) -> Result<(), Self::Error>;

    /// Number of true separate contacts of the body with obstacles so far, for evaluation only. `None` (the default) if only the bumper
    /// reports contacts.
    fn contact_count(&self) -> Option<u32> {
        None
    }
}
