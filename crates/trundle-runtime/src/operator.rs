//! Commands of an operator (a person or a program) to a running robot.

use crate::mission::goal_options::PATIENCE_RANGE_S;
use crate::{Mission, RobotConfig};
use serde::{Deserialize, Serialize};
use trundle_core::{
    GridGeometry, Invalid, MAX_TEXT_CELLS, MapAnnotations, OccupancyGrid, Pose2, SPEED_LIMIT_RANGE_M_S,
    Twist2, require_finite, require_in,
};
use trundle_mapping::GridMapper;

/// A command of an operator to a running robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OperatorCommand {
    /// Replace the present mission by this one. With an empty mission the robot brakes to rest.
    Begin(Mission),
    /// Stop, and keep the mission.
    Pause,
    /// Continue after a pause.
    Continue,
    /// Set the pose of the robot.
    SetPose(PoseGuess),
    /// Change a setting until the end of the run.
    Change(RunSetting),
    /// Replace the zones and named places of the map.
    Annotate(MapAnnotations),
    /// Replace the map by one with the robot file's resolution. Its frame becomes the map frame, and the pose is unknown. The mission is
    /// cancelled; zones, places and charging station of the old map are dropped. If the cells do not fit, the robot keeps its map and its
    /// mission ([`crate::StepReport::map_replaced`]).
    LoadMap(Box<OccupancyGrid>),
    /// Drive with this twist under the safety monitor, and pause the mission. Without another twist within [`TELEOP_SILENCE_S`] the robot
    /// stops.
    Drive(Twist2),
}

/// Time after the operator's last twist at which the robot stops \[s\]. With a longer time, the robot would drive on after a loss of the
/// link. Source: ours; three periods of a page that sends at 10 Hz.
pub const TELEOP_SILENCE_S: f64 = 0.3;

impl OperatorCommand {
    /// The command that cancels the mission: the robot brakes to rest.
    #[must_use]
    pub fn cancel() -> Self {
        Self::Begin(Mission::default())
    }

    /// Returns a command with valid numbers unchanged.
    ///
    /// # Errors
    /// Names the number that is not finite or outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        match self {
            Self::Begin(mission) => Ok(Self::Begin(Mission::new(mission.tasks().to_vec())?)),
            Self::SetPose(guess) => Ok(Self::SetPose(guess.validated()?)),
            Self::Change(setting) => Ok(Self::Change(setting.validated()?)),
            Self::Annotate(annotations) => Ok(Self::Annotate(annotations.validated()?)),
            Self::Drive(twist) => {
                require_finite("speed of the operator's twist", twist.v, "m/s")?;
                require_finite("turn rate of the operator's twist", twist.omega, "rad/s")?;
                Ok(self)
            }
            Self::LoadMap(grid) => require_recordable(grid.geometry()).map(|()| Self::LoadMap(grid)),
            Self::Pause | Self::Continue => Ok(self),
        }
    }
}

/// Refuses a map that is too large for a recording.
fn require_recordable(map: &GridGeometry) -> Result<(), Invalid> {
    let cells = map.len();
    if cells > MAX_TEXT_CELLS {
        let expected = format!("at most {MAX_TEXT_CELLS}");
        return Err(Invalid::new("number of cells of the map", cells, "", expected));
    }
    Ok(())
}

/// Refuses a map that a robot of this configuration cannot use with [`OperatorCommand::LoadMap`].
///
/// # Errors
/// When the map has too many cells, cells of another size, an origin off the multiples of the cell size, or too large an extent.
pub fn require_loadable(map: &GridGeometry, robot: &RobotConfig) -> Result<(), Invalid> {
    require_recordable(map)?;
    GridMapper::require_fits(&robot.mapping, map)
}

/// A pose of the robot with its uncertainty, as given by an operator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseGuess {
    /// `map_from_base`.
    pub pose: Pose2,
    /// Standard deviation of the position along each axis \[m\].
    pub position_sigma: f64,
    /// Standard deviation of the heading \[rad\].
    pub heading_sigma: f64,
}

/// Range of the standard deviation of a guessed position \[m\]. Source: ours; no person points at a map more exactly.
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

/// A setting that may change while the robot runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RunSetting {
    /// `limits.v_m_s`: highest forward speed of the next plans \[m/s\]. The robot file's speed is never exceeded.
    Speed(f64),
    /// `mission_executor.patience_s`: time without progress after which a goal is abandoned \[s\].
    Patience(f64),
}

impl RunSetting {
    /// Key of the setting in the robot file.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Speed(_) => "limits.v_m_s",
            Self::Patience(_) => "mission_executor.patience_s",
        }
    }

    /// Value of the setting, in the unit of the key.
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::Speed(value) | Self::Patience(value) => value,
        }
    }

    /// The setting with a key of the robot file, in the unit of the key; `None` if it cannot change while the robot runs.
    #[must_use]
    pub fn of_key(key: &str, value: f64) -> Option<Self> {
        match key {
            "limits.v_m_s" => Some(Self::Speed(value)),
            "mission_executor.patience_s" => Some(Self::Patience(value)),
            _ => None,
        }
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Speed(_) => SPEED_LIMIT_RANGE_M_S,
            Self::Patience(_) => PATIENCE_RANGE_S,
        }
    }

    fn validated(self) -> Result<Self, Invalid> {
        let (min, max) = self.range();
        match self {
            Self::Speed(value) => require_in("speed limit", value, "m/s", min, max)?,
            Self::Patience(value) => require_in("patience", value, "s", min, max)?,
        };
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
    fn settings_stay_in_their_ranges() {
        let change =
            |key, value| OperatorCommand::Change(RunSetting::of_key(key, value).unwrap()).validated();
        assert!(change("limits.v_m_s", 0.2).is_ok() && change("mission_executor.patience_s", 20.0).is_ok());
        for (key, value) in
            [("limits.v_m_s", 0.0), ("limits.v_m_s", f64::NAN), ("mission_executor.patience_s", 0.5)]
        {
            assert!(change(key, value).is_err(), "{key} {value}");
        }
        assert_eq!(RunSetting::of_key("drive.wheel_radius_m", 0.1), None);
        for setting in [RunSetting::Speed(0.25), RunSetting::Patience(8.0)] {
            assert_eq!(RunSetting::of_key(setting.key(), setting.value()), Some(setting));
            assert!(crate::settings::reference().iter().any(|known| known.key == setting.key()));
        }
    }

    #[test]
    fn a_twist_needs_finite_numbers() {
        assert!(
            OperatorCommand::Drive(Twist2::new(9.0, -9.0)).validated().is_ok(),
            "the limits of the base apply later"
        );
        for wrong in [Twist2::new(f64::NAN, 0.0), Twist2::new(0.0, f64::INFINITY)] {
            assert!(OperatorCommand::Drive(wrong).validated().is_err());
        }
    }

    #[test]
    fn commands_keep_their_form_in_recordings() {
        let text = |command: OperatorCommand| serde_json::to_string(&command).unwrap();
        assert_eq!(text(OperatorCommand::cancel()), r#"{"begin":[]}"#);
        assert_eq!(text(OperatorCommand::Pause), r#""pause""#);
        assert_eq!(text(OperatorCommand::Change(RunSetting::Speed(0.2))), r#"{"change":{"speed":0.2}}"#);
        let begin = OperatorCommand::Begin(Mission::new(vec![Task::Explore, Task::Return]).unwrap());
        assert_eq!(text(begin), r#"{"begin":["explore","return"]}"#);
        assert_eq!(
            text(OperatorCommand::Drive(Twist2::new(0.5, -1.0))),
            r#"{"drive":{"v":0.5,"omega":-1.0}}"#
        );
        assert!(text(guess(1.0, 0.1, 0.2)).contains(r#""position_sigma":0.1"#));
    }
}
