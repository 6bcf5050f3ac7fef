use super::{Hand, SimArgs};
use std::path::Path;
use trundle::app::{AppError, read_text};
use trundle::core::{Invalid, Pose2, Stamp, Twist2};
use trundle::sim::{CommandScript, Following, WaypointFollower};

/// A robot that nobody drives is watched for so long, s.
const STANDING: f64 = 5.0;

/// A robot that has arrived is watched for so long, s: what still rolls counts.
const AFTERMATH: f64 = 0.5;

/// Who drives.
pub enum Driver {
    /// Nobody.
    Nobody,
    /// Commands by the clock.
    Script(CommandScript),
    /// Way-points by the true pose; when it came to its end.
    Waypoints(Box<WaypointFollower>, Option<Stamp>),
    /// Somebody at the keys.
    Hand(Box<Hand>),
}

impl Driver {
    /// The driver that the arguments ask for.
    ///
    /// # Errors
    /// When its file cannot be read, a line of it is wrong, or there is no keyboard.
    pub fn read(args: &SimArgs) -> Result<Self, AppError> {
        if let Some(file) = &args.drive {
            return Ok(Self::Script(parsed(file, CommandScript::parse)?));
        }
        if let Some(file) = &args.follow {
            return Ok(Self::Waypoints(Box::new(parsed(file, WaypointFollower::parse)?), None));
        }
        Ok(if args.keys { Self::Hand(Box::new(Hand::ready()?)) } else { Self::Nobody })
    }

    /// What to drive now that the robot truly stands at `pose`.
    ///
    /// # Errors
    /// When there is no keyboard any more.
    pub fn twist(&mut self, stamp: Stamp, pose: Pose2) -> Result<Twist2, AppError> {
        Ok(match self {
            Self::Nobody => Twist2::ZERO,
            Self::Script(script) => script.at(stamp.as_secs()),
            Self::Waypoints(follower, ended) => {
                let twist = follower.step(stamp, pose);
                if ended.is_none() && !matches!(follower.state(), Following::Driving { .. }) {
                    *ended = Some(stamp);
                }
                twist
            }
            Self::Hand(hand) => hand.twist(stamp)?,
        })
    }

    /// When the drive is over, s, where that is known.
    pub fn end(&self) -> Option<f64> {
        match self {
            Self::Nobody => Some(STANDING),
            Self::Script(script) => Some(script.duration().max(1e-3)),
            Self::Waypoints(_, ended) => ended.map(|stamp| stamp.as_secs() + AFTERMATH),
            Self::Hand(hand) => hand.has_quit().then_some(0.0),
        }
    }

    /// Way-points reached and way-points in all, where there are any.
    pub fn waypoints(&self) -> Option<(usize, usize)> {
        let Self::Waypoints(follower, _) = self else { return None };
        let count = follower.waypoints().len();
        Some(match follower.state() {
            Following::Arrived => (count, count),
            Following::Driving { waypoint } | Following::Blocked { waypoint } => (waypoint, count),
        })
    }
}

fn parsed<T>(file: &Path, parse: impl Fn(&str) -> Result<T, Invalid>) -> Result<T, AppError> {
    let text = read_text(file)?;
    parse(&text).map_err(|invalid| AppError::Input(format!("{}: {invalid}", file.display())))
}
