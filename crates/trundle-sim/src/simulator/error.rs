//! Errors of setting up the simulated robot.

use trundle_core::{Invalid, Stamp};

/// Errors of a simulated robot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A number of the configuration or the scene.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// The start is inside an obstacle.
    #[error(
        "start of scene '{scene}' at ({x:.3}, {y:.3}) m is {penetration:.3} m inside an obstacle, expected a free place"
    )]
    StartInObstacle {
        /// The scene's name.
        scene: String,
        /// Metres, world frame.
        x: f64,
        /// Metres, world frame.
        y: f64,
        /// Metres.
        penetration: f64,
    },
    /// The robot's pose is outside the scene, without a floor.
    #[error(
        "{what} at ({x:.3}, {y:.3}) m is outside scene '{scene}', which reaches from ({:.3}, {:.3}) to ({:.3}, {:.3}) m",
        low[0], low[1], high[0], high[1]
    )]
    OutsideScene {
        /// The start, or a kidnapping and when.
        what: String,
        /// The scene's name.
        scene: String,
        /// Metres, world frame.
        x: f64,
        /// Metres, world frame.
        y: f64,
        /// The scene's lowest x and y, m.
        low: [f64; 2],
        /// The scene's highest x and y, m.
        high: [f64; 2],
    },
    /// A fault would put the robot into an obstacle.
    #[error(
        "kidnapping at {time} s to ({x:.3}, {y:.3}) m of scene '{scene}' is {penetration:.3} m inside an obstacle, expected a free place"
    )]
    KidnappedIntoObstacle {
        /// The scene's name.
        scene: String,
        /// Seconds since the start.
        time: f64,
        /// Metres, world frame.
        x: f64,
        /// Metres, world frame.
        y: f64,
        /// Metres.
        penetration: f64,
    },
    /// A command that is not a number; the robot stops instead.
    #[error(
        "command at {stamp} s is v = {v} m/s, omega = {omega} rad/s, expected finite numbers; the robot stops"
    )]
    CommandNotFinite {
        /// Stamp of the command.
        stamp: Stamp,
        /// Commanded forward speed, m/s.
        v: f64,
        /// Commanded turn rate, rad/s.
        omega: f64,
    },
}
