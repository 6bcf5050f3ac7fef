//! `sensor_msgs/LaserScan`.

use super::stamp;
use crate::generated::sensor_msgs::LaserScan;
use trundle_core::{Beam, BeamTimes, Invalid, Pose2, Scan, Stamp, require_finite, require_in};

/// Largest number of beams of a sweep. Source: ours; a sweep of 0.01 deg has 36,000.
const MAX_BEAMS: usize = 100_000;

/// The sweep of a laser with pose `base_from_laser` on the base, at `stamp` of the run. Beams without echo are free up to the laser's range
/// if infinite, and unseen if NaN or outside the range \[REP 117\].
///
/// # Errors
/// When an angle or a limit is not finite, or the scan has no beam.
pub fn from_ros(message: &LaserScan, stamp: Stamp, base_from_laser: &Pose2) -> Result<Scan, Invalid> {
    let increment = require_finite("angle_increment", f64::from(message.angle_increment), "rad")?;
    let (near, far) = (f64::from(message.range_min), f64::from(message.range_max));
    require_in("range_max", far, "m", 0.1, 1000.0)?;
    require_in("range_min", near, "m", 0.0, far)?;
    let count = message.ranges.len();
    if count == 0 || count > MAX_BEAMS {
        return Err(Invalid::new("number of ranges", count, "", "1 to 100000"));
    }
    let beam = |range: &f32| match f64::from(*range) {
        range if range == f64::INFINITY => Beam::Free { range: far },
        range if range >= near && range <= far && range > 0.0 => Beam::Hit { range },
        _ => Beam::Unseen,
    };
    let mut beams: Vec<Beam> = message.ranges.iter().map(beam).collect();
    let mut first = f64::from(message.angle_min);
    let mut times = BeamTimes { first_s: 0.0, step_s: f64::from(message.time_increment) };
    if increment < 0.0 {
        beams.reverse();
        first += increment * (count - 1) as f64;
        times = BeamTimes { first_s: times.of(count - 1), step_s: -times.step_s };
    }
    let origin = base_from_laser.position();
    let scan = Scan::new(stamp, origin, first + base_from_laser.theta, increment.abs(), beams)?;
    // Invalid times are ignored.
    Ok(if times.step_s == 0.0 { scan } else { scan.clone().with_beam_times(times).unwrap_or(scan) })
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

    #[test]
    fn beams_follow_rep_117_and_a_turned_laser_is_turned() {
        let ranges = [1.0, f32::INFINITY, f32::NAN, 9.0, f32::NEG_INFINITY];
        let on_base = Pose2::new(0.1, 0.0, std::f64::consts::PI);
        let scan = from_ros(&message(&ranges, 0.25), Stamp::default(), &on_base).unwrap();
        let expected =
            [Beam::Hit { range: 1.0 }, Beam::Free { range: 5.0 }, Beam::Unseen, Beam::Unseen, Beam::Unseen];
        assert_eq!(scan.beams(), expected);
        assert!((scan.angle(0) - (std::f64::consts::PI - 0.5)).abs() < 1e-7);
        let falling = from_ros(&message(&ranges, -0.25), Stamp::default(), &Pose2::IDENTITY).unwrap();
        assert_eq!(falling.beams()[4], Beam::Hit { range: 1.0 });
        assert!((falling.angle(4) + 0.5).abs() < 1e-7);
    }

    #[test]
    fn broken_sweeps_are_refused() {
        let refused = |message: LaserScan| {
            from_ros(&message, Stamp::default(), &Pose2::IDENTITY).unwrap_err().to_string()
        };
        assert!(refused(message(&[], 0.1)).starts_with("number of ranges is 0"));
        assert!(refused(message(&[1.0], f32::NAN)).starts_with("angle_increment is NaN"));
        assert!(
            refused(LaserScan { range_max: f32::NAN, ..message(&[1.0], 0.1) })
                .starts_with("range_max is NaN")
        );
    }

    #[test]
    fn a_scan_goes_there_and_back() {
        let scan =
            from_ros(&message(&[1.0, f32::INFINITY, f32::NAN], 0.25), Stamp::default(), &Pose2::IDENTITY)
                .unwrap();
        let back =
            from_ros(&to_ros(&scan, Stamp::default(), "base_scan", 5.0), Stamp::default(), &Pose2::IDENTITY)
                .unwrap();
        assert_eq!(back.beams(), scan.beams());
    }
}
