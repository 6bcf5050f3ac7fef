//! Commands of an operator (a person or a program) to a running robot.

use crate::mission::executor_config::{ARRIVAL_BOUND_RANGE_M, ARRIVAL_HEADING_RANGE_DEG};
use crate::mission::goal_options::PATIENCE_RANGE_S;
use crate::{Mission, RobotConfig};
use serde::{Deserialize, Serialize};
use trundle_core::{
    DriveLimits, GridGeometry, Invalid, MAX_TEXT_CELLS, MapAnnotations, OccupancyGrid, Pose2,
    SPEED_LIMIT_RANGE_M_S, Twist2, require_finite, require_in,
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
    /// Stop until the program is started anew: the link by which others give and cancel goals has died. A person may still drive by hand.
    GoalLinkLost,
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

    /// Whether the command decides if the robot moves: a later stop replaces it.
    #[must_use]
    pub fn decides_motion(&self) -> bool {
        matches!(self, Self::Begin(_) | Self::Pause | Self::Continue | Self::Drive(_))
    }

    /// Whether the command begins or ends a pause.
    #[must_use]
    pub fn decides_pause(&self) -> bool {
        matches!(self, Self::Pause | Self::Continue | Self::Drive(_))
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
            Self::Pause | Self::Continue | Self::GoalLinkLost => Ok(self),
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
    /// `limits.omega_rad_s`: highest turn rate of the next plans \[rad/s\]. The robot file's turn rate is never exceeded.
    TurnRate(f64),
    /// `mission_executor.patience_s`: time without progress after which a goal is abandoned \[s\].
    Patience(f64),
    /// `mission_executor.arrival_bound_m`: bound of the position's error up to which an arrival is certain \[m\].
    ArrivalBound(f64),
    /// `mission_executor.arrival_heading_bound_deg`: bound of the heading's error up to which an arrival is certain \[deg\].
    ArrivalHeadingBound(f64),
}

/// The settings that may change while the robot runs, in the order of [`RunSetting`].
pub type RunSettings = [RunSetting; 5];

/// Range of the limit of the turn rate \[rad/s\]. Source: ours; a slower robot seems to stand.
const TURN_RATE_RANGE_RAD_S: (f64, f64) = (0.05, 10.0);

impl RunSetting {
    /// All settings, with the values of a robot file.
    #[must_use]
    pub fn all_of(robot: &RobotConfig) -> RunSettings {
        let executor = &robot.mission_executor;
        [
            Self::Speed(robot.limits.v),
            Self::TurnRate(robot.limits.omega),
            Self::Patience(executor.patience),
            Self::ArrivalBound(executor.arrival_bound),
            Self::ArrivalHeadingBound(executor.arrival_heading_bound_deg),
        ]
    }

    /// Key of the setting in the robot file.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Speed(_) => "limits.v_m_s",
            Self::TurnRate(_) => "limits.omega_rad_s",
            Self::Patience(_) => "mission_executor.patience_s",
            Self::ArrivalBound(_) => "mission_executor.arrival_bound_m",
            Self::ArrivalHeadingBound(_) => "mission_executor.arrival_heading_bound_deg",
        }
    }

    /// Value of the setting, in the unit of the key.
    #[must_use]
    pub fn value(self) -> f64 {
        match self {
            Self::Speed(value)
            | Self::TurnRate(value)
            | Self::Patience(value)
            | Self::ArrivalBound(value)
            | Self::ArrivalHeadingBound(value) => value,
        }
    }

    /// The setting with a key of the robot file, in the unit of the key; `None` if it cannot change while the robot runs.
    #[must_use]
    pub fn of_key(key: &str, value: f64) -> Option<Self> {
        let all =
            [Self::Speed, Self::TurnRate, Self::Patience, Self::ArrivalBound, Self::ArrivalHeadingBound];
        all.into_iter().map(|setting| setting(value)).find(|setting| setting.key() == key)
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Speed(_) => SPEED_LIMIT_RANGE_M_S,
            Self::TurnRate(_) => TURN_RATE_RANGE_RAD_S,
            Self::Patience(_) => PATIENCE_RANGE_S,
            Self::ArrivalBound(_) => ARRIVAL_BOUND_RANGE_M,
            Self::ArrivalHeadingBound(_) => ARRIVAL_HEADING_RANGE_DEG,
        }
    }

    /// Smallest and largest value of a robot with these limits: it is never faster than they are.
    #[must_use]
    pub fn range_within(self, limits: &DriveLimits) -> (f64, f64) {
        let (min, max) = self.range();
        match self {
            Self::Speed(_) => (min, max.min(limits.v)),
            Self::TurnRate(_) => (min, max.min(limits.omega)),
            _ => (min, max),
        }
    }

    fn validated(self) -> Result<Self, Invalid> {
        let (min, max) = self.range();
        let (name, unit) = match self {
            Self::Speed(_) => ("speed limit", "m/s"),
            Self::TurnRate(_) => ("limit of the turn rate", "rad/s"),
            Self::Patience(_) => ("patience", "s"),
            Self::ArrivalBound(_) => ("bound of an arrival's position", "m"),
            Self::ArrivalHeadingBound(_) => ("bound of an arrival's heading", "deg"),
        };
        require_in(name, self.value(), unit, min, max)?;
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
        for setting in RunSetting::all_of(&RobotConfig::default()) {
            assert!(setting.validated().is_ok(), "{setting:?}");
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
        assert_eq!(text(OperatorCommand::GoalLinkLost), r#""goal_link_lost""#);
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
