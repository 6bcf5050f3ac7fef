//! Commands of an operator to a robot that runs: a person at a page, or a program.

use crate::Mission;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, require_finite, require_in};

/// A command of an operator to a robot that runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OperatorCommand {
    /// Begin this mission in place of what is left of the present one. From an empty mission on the robot brakes to rest.
    Begin(Mission),
    /// Stop, and keep the mission.
    Pause,
    /// Go on after a pause.
    Continue,
    /// The pose of the robot, as the operator knows it.
    SetPose(PoseGuess),
}

impl OperatorCommand {
    /// Takes the mission away: the robot brakes to rest.
    #[must_use]
    pub fn cancel() -> Self {
        Self::Begin(Mission::default())
    }

    /// The command, its numbers checked.
    ///
    /// # Errors
    /// Names the number that is not finite or outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        match self {
            Self::Begin(mission) => Ok(Self::Begin(Mission::new(mission.tasks().to_vec())?)),
            Self::SetPose(guess) => Ok(Self::SetPose(guess.validated()?)),
            Self::Pause | Self::Continue => Ok(self),
        }
    }
}

/// A pose of the robot with its uncertainty, as an operator knows it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseGuess {
    /// `map_from_base`.
    pub pose: Pose2,
    /// Standard deviation of the position along each axis \[m\].
    pub position_sigma: f64,
    /// Standard deviation of the heading \[rad\].
    pub heading_sigma: f64,
}

/// Range of the standard deviation of a guessed position \[m\]. Source: ours; below it a person cannot point at a map.
const POSITION_SIGMA_RANGE_M: (f64, f64) = (0.001, 10.0);
/// Range of the standard deviation of a guessed heading \[rad\]. Source: ours.
const HEADING_SIGMA_RANGE_RAD: (f64, f64) = (0.001, std::f64::consts::PI);

impl PoseGuess {
    fn validated(self) -> Result<Self, Invalid> {
        require_finite("x of the given pose", self.pose.x, "m")?;
        require_finite("y of the given pose", self.pose.y, "m")?;
        require_finite("heading of the given pose", self.pose.theta, "rad")?;
        let (min, max) = POSITION_SIGMA_RANGE_M;
        require_in("standard deviation of the given position", self.position_sigma, "m", min, max)?;
        let (min, max) = HEADING_SIGMA_RANGE_RAD;
        require_in("standard deviation of the given heading", self.heading_sigma, "rad", min, max)?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Task;

    fn guess(x: f64, position_sigma: f64, heading_sigma: f64) -> OperatorCommand {
        OperatorCommand::SetPose(PoseGuess { pose: Pose2::new(x, 0.0, 0.0), position_sigma, heading_sigma })
    }

    #[test]
    fn a_pose_needs_finite_numbers_and_a_believable_uncertainty() {
        assert!(guess(1.0, 0.1, 0.1).validated().is_ok());
        for wrong in [guess(f64::NAN, 0.1, 0.1), guess(1.0, 0.0, 0.1), guess(1.0, 0.1, f64::INFINITY)] {
            assert!(wrong.validated().is_err());
        }
    }

    #[test]
    fn commands_keep_their_form_in_recordings() {
        let text = |command: OperatorCommand| serde_json::to_string(&command).unwrap();
        assert_eq!(text(OperatorCommand::cancel()), r#"{"begin":[]}"#);
        assert_eq!(text(OperatorCommand::Pause), r#""pause""#);
        let begin = OperatorCommand::Begin(Mission::new(vec![Task::Explore, Task::Return]).unwrap());
        assert_eq!(text(begin), r#"{"begin":["explore","return"]}"#);
        assert!(text(guess(1.0, 0.1, 0.2)).contains(r#""position_sigma":0.1"#));
    }
}
