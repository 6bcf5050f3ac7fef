//! `sensor_msgs/LaserScan`.

use super::stamp;
use crate::generated::sensor_msgs::LaserScan;
use trundle_core::{Beam, Pose3, Scan, Stamp};
use trundle_io::{LaserSweep, NoEcho};

/// The sweep of a laser with pose `base_from_laser` on the base, at `stamp` of the run. Beams without echo are free up to the laser's range
/// if infinite, and unseen if NaN or outside the range \[REP 117\].
///
/// # Errors
/// As [`LaserSweep::on_base`].
pub fn from_ros(message: &LaserScan, stamp: Stamp, base_from_laser: &Pose3) -> Result<Scan, String> {
    let sweep = LaserSweep {
        stamp,
        angle_min: f64::from(message.angle_min),
        angle_increment: f64::from(message.angle_increment),
        time_increment: f64::from(message.time_increment),
        range_min: f64::from(message.range_min),
        range_max: f64::from(message.range_max),
        ranges: &message.ranges,
    };
    sweep.on_base(base_from_laser, None, NoEcho::Free).map(|converted| converted.scan)
}

/// The scan as a message in the frame `frame`, at the scan's origin with the axes of the base. `far` is the range of beams without obstacle
/// \[m\].
#[must_use]
pub fn to_ros(scan: &Scan, at: Stamp, frame: &str, far: f64) -> LaserScan {
    let range = |beam: &Beam| match beam {
        Beam::Hit { range } => *range as f32,
        Beam::Free { .. } => f32::INFINITY,
        Beam::Unseen => f32::NAN,
    };
    let last = scan.beams().len().saturating_sub(1);
    LaserScan {
        header: stamp::header(at, frame),
        angle_min: scan.angle_min() as f32,
        angle_max: scan.angle(last) as f32,
        angle_increment: scan.angle_increment() as f32,
        range_min: 0.0,
        range_max: far as f32,
        ranges: scan.beams().iter().map(range).collect(),
        ..LaserScan::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Pose2;

    fn message(ranges: &[f32], increment: f32) -> LaserScan {
        let (angle_min, range_max) = (-0.5, 5.0);
        LaserScan {
            angle_min,
            angle_increment: increment,
            range_max,
            ranges: ranges.to_vec(),
            ..LaserScan::default()
        }
    }

    /// The kinds of the beams and their ranges, rounded to micrometres.
    fn beams(scan: &Scan) -> Vec<(&'static str, f64)> {
        let rounded = |range: f64| (range * 1e6).round() / 1e6;
        let kind = |beam: &Beam| match beam {
            Beam::Hit { range } => ("hit", rounded(*range)),
            Beam::Free { range } => ("free", rounded(*range)),
            Beam::Unseen => ("unseen", 0.0),
        };
        scan.beams().iter().map(kind).collect()
    }

    #[test]
    fn beams_follow_rep_117_and_a_turned_laser_is_turned() {
        let ranges = [1.0, f32::INFINITY, f32::NAN, 9.0, f32::NEG_INFINITY];
        let on_base = Pose3::from_pose2(Pose2::new(0.1, 0.0, std::f64::consts::PI));
        let scan = from_ros(&message(&ranges, 0.25), Stamp::default(), &on_base).unwrap();
        let unseen = ("unseen", 0.0);
        assert_eq!(beams(&scan), [("hit", 1.0), ("free", 5.0), unseen, unseen, unseen]);
        assert!((scan.angle(0) - (std::f64::consts::PI - 0.5)).abs() < 1e-7);
        let falling = from_ros(&message(&ranges, -0.25), Stamp::default(), &Pose3::identity()).unwrap();
        assert_eq!(beams(&falling)[4], ("hit", 1.0));
        assert!((falling.angle(4) + 0.5).abs() < 1e-7);
    }

    #[test]
    fn a_laser_upside_down_sweeps_the_other_way() {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(std::f64::consts::PI, 0.0, 0.0);
        let mount = Pose3::new(turn, nalgebra::Vector3::zeros());
        let scan = from_ros(&message(&[1.0, 2.0, 3.0], 0.25), Stamp::default(), &mount).unwrap();
        assert_eq!(beams(&scan), [("hit", 3.0), ("hit", 2.0), ("hit", 1.0)]);
        assert!((scan.angle(2) - 0.5).abs() < 1e-7, "{}", scan.angle(2));
    }

    #[test]
    fn broken_sweeps_are_refused() {
        let refused =
            |message: LaserScan| from_ros(&message, Stamp::default(), &Pose3::identity()).unwrap_err();
        assert!(refused(message(&[], 0.1)).starts_with("0 ranges, expected 1 to 100000"));
        assert!(refused(message(&[1.0], f32::NAN)).starts_with("angle_increment is NaN"));
        assert!(
            refused(LaserScan { range_max: f32::NAN, ..message(&[1.0], 0.1) })
                .starts_with("range_max is NaN")
        );
    }

    #[test]
    fn a_scan_goes_there_and_back() {
        let flat = Pose3::identity();
        let scan =
            from_ros(&message(&[1.0, f32::INFINITY, f32::NAN], 0.25), Stamp::default(), &flat).unwrap();
        let sent = to_ros(&scan, Stamp::default(), "base_scan", 5.0);
        assert_eq!(beams(&from_ros(&sent, Stamp::default(), &flat).unwrap()), beams(&scan));
    }
}
