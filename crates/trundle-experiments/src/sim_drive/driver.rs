//! Drivers of the simulated robot.

use std::path::Path;
use trundle_app::{AppError, read_text};
use trundle_core::{Invalid, Pose2, RgbdImage, Scan, Stamp, Twist2};
use trundle_sim::{CommandScript, Following, Simulator, WaypointFollower};

/// Time for which a robot without a driver is simulated \[s\]. Source: ours.
const STANDING_S: f64 = 5.0;

/// Time for which the simulation continues after the last way-point, until the wheels are at rest \[s\]. Source: ours.
const AFTER_ARRIVAL_S: f64 = 0.5;

/// Commands the simulated robot.
pub trait SimDriver {
    /// The twist for a robot with the true pose `pose`.
    ///
    /// # Errors
    /// When the driver's device fails.
    fn twist(&mut self, stamp: Stamp, pose: Pose2) -> Result<Twist2, AppError>;

    /// End of the drive, s; `None` if unknown.
    fn end_s(&self) -> Option<f64>;

    /// Number of reached way-points and of all way-points; `None` without way-points.
    fn waypoints(&self) -> Option<(usize, usize)> {
        None
    }

    /// Shows the newest image to the driver.
    fn show(&mut self, _image: &RgbdImage, _robot: &Simulator) {}

    /// Shows the newest sweep of the laser to the driver.
    fn show_scan(&mut self, _scan: &Scan, _robot: &Simulator) {}
}

/// A driver that does not move.
#[derive(Debug, Clone, Copy)]
pub struct StillDriver {
    end_s: f64,
}

impl StillDriver {
    /// Rests for this time, s; `None` for 5 s.
    #[must_use]
    pub fn new(seconds: Option<f64>) -> Self {
        Self { end_s: seconds.unwrap_or(STANDING_S) }
    }
}

impl SimDriver for StillDriver {
    fn twist(&mut self, _stamp: Stamp, _pose: Pose2) -> Result<Twist2, AppError> {
        Ok(Twist2::ZERO)
    }

    fn end_s(&self) -> Option<f64> {
        Some(self.end_s)
    }
}

/// A driver with the timed commands of a file.
#[derive(Debug)]
pub struct ScriptDriver(CommandScript);

impl ScriptDriver {
    /// The commands of a file.
    ///
    /// # Errors
    /// Names the file and the line.
    pub fn read(file: &Path) -> Result<Self, AppError> {
        Ok(Self(parsed(file, CommandScript::parse)?))
    }
}

impl SimDriver for ScriptDriver {
    fn twist(&mut self, stamp: Stamp, _pose: Pose2) -> Result<Twist2, AppError> {
        Ok(self.0.at(stamp.as_secs()))
    }

    fn end_s(&self) -> Option<f64> {
        Some(self.0.duration().max(1e-3))
    }
}

/// A driver to the way-points of a file, by the true pose.
#[derive(Debug)]
pub struct WaypointDriver {
    follower: WaypointFollower,
    ended: Option<Stamp>,
}

impl WaypointDriver {
    /// The way-points of a file.
    ///
    /// # Errors
    /// Names the file and the line.
    pub fn read(file: &Path) -> Result<Self, AppError> {
        Ok(Self { follower: parsed(file, WaypointFollower::parse)?, ended: None })
    }
}

impl SimDriver for WaypointDriver {
    fn twist(&mut self, stamp: Stamp, pose: Pose2) -> Result<Twist2, AppError> {
        let twist = self.follower.step(stamp, pose);
        if self.ended.is_none() && !matches!(self.follower.state(), Following::Driving { .. }) {
            self.ended = Some(stamp);
        }
        Ok(twist)
    }

    fn end_s(&self) -> Option<f64> {
        self.ended.map(|stamp| stamp.as_secs() + AFTER_ARRIVAL_S)
    }

    fn waypoints(&self) -> Option<(usize, usize)> {
        let count = self.follower.waypoints().len();
        Some(match self.follower.state() {
            Following::Arrived => (count, count),
            Following::Driving { waypoint } | Following::Blocked { waypoint } => (waypoint, count),
        })
    }
}

fn parsed<T>(file: &Path, parse: impl Fn(&str) -> Result<T, Invalid>) -> Result<T, AppError> {
    let text = read_text(file)?;
    parse(&text).map_err(|invalid| AppError::Input(format!("{}: {invalid}", file.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(text: &str) -> (tempfile::TempDir, std::path::PathBuf) {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("drive.txt");
        std::fs::write(&path, text).unwrap();
        (scratch, path)
    }

    #[test]
    fn a_standing_robot_is_simulated_for_the_time_asked_for() {
        assert_eq!(StillDriver::new(None).end_s(), Some(STANDING_S));
        let mut standing = StillDriver::new(Some(2.0));
        assert_eq!(standing.end_s(), Some(2.0));
        assert_eq!(standing.twist(Stamp::default(), Pose2::IDENTITY).unwrap(), Twist2::ZERO);
    }

    #[test]
    fn a_script_ends_with_its_last_command() {
        let (_scratch, path) = file("0 0.2 0\n1.5 0 0\n");
        let mut script = ScriptDriver::read(&path).unwrap();
        assert_eq!(
            script.twist(Stamp::from_secs(0.5).unwrap(), Pose2::IDENTITY).unwrap(),
            Twist2::new(0.2, 0.0)
        );
        assert_eq!((script.end_s(), script.waypoints()), (Some(1.5), None));
    }

    #[test]
    fn way_points_are_counted_when_they_are_reached() {
        let (_scratch, path) = file("0 0 0\n");
        let mut driver = WaypointDriver::read(&path).unwrap();
        assert_eq!((driver.end_s(), driver.waypoints()), (None, Some((0, 1))));
        for i in 0..100 {
            driver.twist(Stamp::from_secs(f64::from(i) * 0.1).unwrap(), Pose2::IDENTITY).unwrap();
        }
        assert_eq!(driver.waypoints(), Some((1, 1)));
        assert!(driver.end_s().is_some());
    }

    #[test]
    fn a_wrong_line_is_named_with_its_file() {
        let (_scratch, path) = file("0 fast 0\n");
        let error = ScriptDriver::read(&path).unwrap_err().to_string();
        assert!(error.contains("drive.txt") && error.contains("line 1"), "{error}");
        assert!(WaypointDriver::read(Path::new("no-such-file")).is_err());
    }
}
