//! Writer and reader of laser logs in the CARMEN format.

mod laser_survey;
mod line;
mod log;
mod mount;
mod parameters;
mod ranges;
mod scans;
mod survey;
mod text;

pub use log::read_carmen;
pub(crate) use scans::CarmenScans;

use std::fmt::Write;
use trundle_core::{Beam, Pose2, Scan, Stamp, Twist2};

/// The log of a laser and odometry in CARMEN's form, which most 2-D mapping programs read.
///
/// A sweep is a line `ROBOTLASER1`, a wheel pose a line `ODOM`; both are in the odometry's frame. A beam without a return has the maximum
/// range, both for free space and for a failure: the format has no distinction.
#[derive(Debug, Clone)]
pub struct CarmenLog {
    text: String,
    max_range: f64,
    /// `odom_from_base` of the newest `ODOM`.
    pose: Pose2,
    twist: Twist2,
}

impl CarmenLog {
    /// An empty log of a laser that reaches `max_range` m.
    pub fn new(max_range: f64) -> Self {
        let text = "# CARMEN log\nPARAM robot_frontlaser_offset 0.0 nohost 0\n".to_owned();
        Self { text, max_range, pose: Pose2::IDENTITY, twist: Twist2::ZERO }
    }

    /// Adds the pose of the base by the wheels, `odom_from_base`, and its twist.
    pub fn odometry(&mut self, stamp: Stamp, pose: Pose2, twist: Twist2) {
        (self.pose, self.twist) = (pose, twist);
        let Pose2 { x, y, theta } = pose;
        self.line(&format!("ODOM {x:.6} {y:.6} {theta:.6} {:.6} {:.6} 0", twist.v, twist.omega), stamp);
    }

    /// Adds a sweep, taken at the newest odometry pose.
    pub fn scan(&mut self, scan: &Scan) {
        let count = scan.beams().len();
        let mut text = format!(
            "ROBOTLASER1 0 {:.9} {:.9} {:.9} {:.3} 0.01 0 {count}",
            scan.angle_min(),
            scan.angle_increment() * count.saturating_sub(1) as f64,
            scan.angle_increment(),
            self.max_range,
        );
        for beam in scan.beams() {
            let range = match beam {
                Beam::Hit { range } => *range,
                Beam::Free { .. } | Beam::Unseen => self.max_range,
            };
            write!(text, " {range:.3}").expect("invariant: a String takes any text");
        }
        text.push_str(" 0");
        for place in [self.pose.transform(scan.origin()), self.pose.position()] {
            write!(text, " {:.6} {:.6} {:.6}", place.x, place.y, self.pose.theta)
                .expect("invariant: a String takes any text");
        }
        write!(text, " {:.6} {:.6} 0 0 0", self.twist.v, self.twist.omega)
            .expect("invariant: a String takes any text");
        self.line(&text, scan.stamp());
    }

    /// The text of the log.
    pub fn into_text(self) -> String {
        self.text
    }

    /// A CARMEN line ends with the sensor's time, a host, and the logger's time.
    fn line(&mut self, content: &str, stamp: Stamp) {
        writeln!(self.text, "{content} {stamp} trundle {stamp}").expect("invariant: a String takes any text");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    #[test]
    fn a_sweep_has_all_fields_in_their_places() {
        let mut log = CarmenLog::new(5.6);
        log.odometry(Stamp::from_nanos(1_000_000_000), Pose2::new(1.0, 2.0, 0.5), Twist2::new(0.3, 0.1));
        let beams = vec![Beam::Hit { range: 1.25 }, Beam::Free { range: 5.6 }, Beam::Unseen];
        let stamp = Stamp::from_nanos(1_500_000_000);
        log.scan(&Scan::new(stamp, Vector2::new(0.1, 0.0), -0.5, 0.5, beams).unwrap());
        let text = log.into_text();
        let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with(['#', 'P'])).collect();
        assert_eq!(
            lines[0],
            "ODOM 1.000000 2.000000 0.500000 0.300000 0.100000 0 1.000000000 trundle 1.000000000"
        );
        let fields: Vec<&str> = lines[1].split(' ').collect();
        assert_eq!(fields[..5], ["ROBOTLASER1", "0", "-0.500000000", "1.000000000", "0.500000000"]);
        assert_eq!(fields[8..13], ["3", "1.250", "5.600", "5.600", "0"]);
        assert_eq!(fields[13..16], ["1.087758", "2.047943", "0.500000"]); // the laser's place
        assert_eq!(fields[16..19], ["1.000000", "2.000000", "0.500000"]); // the robot's
        assert_eq!(fields[24..], ["1.500000000", "trundle", "1.500000000"]);
    }
}
