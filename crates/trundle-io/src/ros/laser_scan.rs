//! Conversion of the sweep of a `LaserScan` message into a scan in the base frame.

use crate::laser_log::check_sweep;
use trundle_core::{Beam, BeamTimes, Pose3, Scan, Stamp, Vector3};

/// The sweep of a laser in its own frame, the fields of `sensor_msgs/LaserScan`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaserSweep<'a> {
    /// Time of the first beam.
    pub stamp: Stamp,
    /// Angle of the first beam about the laser's z, rad.
    pub angle_min: f64,
    /// Angle from a beam to the next, rad.
    pub angle_increment: f64,
    /// Time between two beams, s. 0: all beams are measured at the stamp.
    pub time_increment: f64,
    /// Smallest valid range, m.
    pub range_min: f64,
    /// Largest valid range, m.
    pub range_max: f64,
    /// Range of each beam, m.
    pub ranges: &'a [f32],
}

/// What a beam with an infinite range says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoEcho {
    /// Nothing: for maps of logs, whose lasers report glass and dark walls in this way as well.
    Unseen,
    /// The beam is free up to the laser's range \[REP 117\]: for robots, which remove obstacles from their map.
    Free,
}

/// A scan in the base frame, made of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvertedScan {
    /// The scan.
    pub scan: Scan,
    /// Number of ranges that were negative, zero, NaN, or too near for the laser.
    pub bad_ranges: usize,
}

/// A laser whose plane is tilted by more than this does not see one plane of the room, deg. Source: ours.
const MAX_TILTED_DEG: f64 = 15.0;

/// Largest range of a laser, m. A longer one is no return. Source: ours; lasers for surveying of landscapes reach further.
const MAX_LASER_RANGE_M: f64 = 1000.0;

impl LaserSweep<'_> {
    /// The scan of a laser at `base_from_laser`: turned, to the side, upside down, its beams in either order.
    ///
    /// Ranges from `max_range` on have no return; negative ones, zero, NaN and those below the laser's least range are bad. Both are
    /// unseen: that nothing came back does not prove that nothing is there. `no_echo` says what infinite ranges are.
    ///
    /// # Errors
    /// With a sentence: no or too many beams, angles that are not angles, or a laser that is tilted.
    pub fn on_base(
        &self,
        base_from_laser: &Pose3,
        max_range: Option<f64>,
        no_echo: NoEcho,
    ) -> Result<ConvertedScan, String> {
        check(self)?;
        let up = base_from_laser.rotate(Vector3::z()).z;
        let tilt = up.abs().min(1.0).acos().to_degrees();
        if tilt > MAX_TILTED_DEG {
            return Err(format!("the laser is tilted by {tilt:.1} deg, expected at most {MAX_TILTED_DEG}"));
        }
        let ahead = base_from_laser.rotate(Vector3::x());
        let turn = ahead.y.atan2(ahead.x);
        let hand = if up < 0.0 { -1.0 } else { 1.0 };
        let (mut beams, bad_ranges) = self.beams(base_from_laser, max_range, no_echo);
        let falls = hand * self.angle_increment < 0.0;
        if falls {
            beams.reverse();
        }
        let first = turn + hand * self.angle(if falls { self.ranges.len() - 1 } else { 0 });
        let origin = base_from_laser.translation.xy();
        let scan = Scan::new(self.stamp, origin, first, self.angle_increment.abs(), beams);
        let scan = timed(scan.map_err(|invalid| invalid.to_string())?, self.time_increment, falls);
        Ok(ConvertedScan { scan, bad_ranges })
    }

    /// Angle of a beam about the laser's z, rad.
    fn angle(&self, beam: usize) -> f64 {
        self.angle_min + beam as f64 * self.angle_increment
    }

    /// The beams in the message's order, projected on the floor, and the number of bad ranges.
    fn beams(&self, base_from_laser: &Pose3, max_range: Option<f64>, no_echo: NoEcho) -> (Vec<Beam>, usize) {
        let limit = max_range.unwrap_or(f64::INFINITY).min(self.range_max).min(MAX_LASER_RANGE_M);
        let shows_free = no_echo == NoEcho::Free && self.range_max <= MAX_LASER_RANGE_M;
        let (mut beams, mut bad_ranges) = (Vec::with_capacity(self.ranges.len()), 0);
        for (i, range) in self.ranges.iter().map(|range| f64::from(*range)).enumerate() {
            let bad = range.is_nan() || range <= 0.0 || range < self.range_min;
            bad_ranges += usize::from(bad);
            let angle = self.angle(i);
            let flat = base_from_laser.rotate(Vector3::new(angle.cos(), angle.sin(), 0.0)).xy().norm();
            beams.push(match range {
                _ if !bad && range < limit => Beam::Hit { range: range * flat },
                f64::INFINITY if shows_free => Beam::Free { range: limit * flat },
                _ => Beam::Unseen,
            });
        }
        (beams, bad_ranges)
    }
}

/// The scan with the times of its beams where the message gives them, within 10 s of its stamp. `falls`: whether the last beam was measured
/// first.
fn timed(scan: Scan, time_increment: f64, falls: bool) -> Scan {
    if time_increment == 0.0 {
        return scan;
    }
    let last = scan.beams().len().saturating_sub(1) as f64;
    let (first_s, step_s) =
        if falls { (last * time_increment, -time_increment) } else { (0.0, time_increment) };
    scan.clone().with_beam_times(BeamTimes { first_s, step_s }).unwrap_or(scan)
}

fn check(message: &LaserSweep<'_>) -> Result<(), String> {
    let names = ["angle_min", "angle_increment"];
    check_sweep(names, message.angle_min, message.angle_increment, message.ranges.len())?;
    if message.range_max.is_nan() || message.range_max <= 0.0 {
        return Err(format!("range_max is {} m, expected more than 0", message.range_max));
    }
    if message.range_min >= message.range_max {
        let (min, max) = (message.range_min, message.range_max);
        return Err(format!(
            "range_min is {min} m and range_max {max} m, expected range_min below range_max"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};
    use trundle_core::{Pose2, Vector2};

    fn message(ranges: &[f32]) -> LaserSweep<'_> {
        LaserSweep {
            stamp: Stamp::from_nanos(5),
            angle_min: -0.5,
            angle_increment: 0.25,
            time_increment: 0.0,
            range_min: 0.1,
            range_max: 10.0,
            ranges,
        }
    }

    fn mounted(x: f64, roll: f64, pitch: f64, yaw: f64) -> Pose3 {
        let rotation = nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Pose3::new(rotation, Vector3::new(x, 0.0, 0.2))
    }

    fn convert(
        message: &LaserSweep<'_>,
        mount: &Pose3,
        max_range: Option<f64>,
    ) -> Result<ConvertedScan, String> {
        message.on_base(mount, max_range, NoEcho::Unseen)
    }

    fn points(message: &LaserSweep<'_>, mount: &Pose3) -> Vec<Vector2> {
        convert(message, mount, None).unwrap().scan.hits().collect()
    }

    #[test]
    fn any_mounting_puts_the_points_where_the_transform_does() {
        for (roll, yaw) in [(0.0, 0.0), (PI, 0.0), (0.0, FRAC_PI_2), (PI, -2.5), (PI, PI)] {
            for (first, step) in [(-0.5, 0.25), (0.5, -0.25)] {
                let laser =
                    LaserSweep { angle_min: first, angle_increment: step, ..message(&[1.0, 2.0, 3.0]) };
                let mount = mounted(0.3, roll, 0.0, yaw);
                let mut expected: Vec<Vector2> = (0..3)
                    .map(|i| {
                        let (angle, range) = (first + step * f64::from(i), f64::from(i + 1));
                        mount.transform(Vector3::new(angle.cos(), angle.sin(), 0.0) * range).xy()
                    })
                    .collect();
                let found = points(&laser, &mount);
                expected.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
                for point in &expected {
                    assert!(
                        found.iter().any(|p| (p - point).norm() < 1e-6),
                        "{roll} {yaw} {step}: {found:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn bad_ranges_are_unseen_and_counted() {
        let found = convert(
            &message(&[-1.0, f32::NAN, f32::INFINITY, 0.05, 2.0, 0.0, 10.5]),
            &Pose3::identity(),
            None,
        )
        .unwrap();
        assert_eq!(found.bad_ranges, 4);
        assert_eq!(found.scan.beams()[4], Beam::Hit { range: 2.0 });
        assert_eq!(found.scan.beams().iter().filter(|b| **b == Beam::Unseen).count(), 6);
        let limited = convert(&message(&[1.0, 2.0]), &Pose3::identity(), Some(1.5)).unwrap();
        assert_eq!(limited.scan.beams(), [Beam::Hit { range: 1.0 }, Beam::Unseen]);
    }

    #[test]
    fn an_infinite_range_is_free_for_a_robot_up_to_the_range_of_a_laser() {
        let ranges = [f32::INFINITY, f32::NEG_INFINITY, 12.0];
        let flat = Pose3::identity();
        let beams = |message: &LaserSweep<'_>| {
            message.on_base(&flat, None, NoEcho::Free).unwrap().scan.into_parts().beams
        };
        let [Beam::Free { range }, Beam::Unseen, Beam::Unseen] = beams(&message(&ranges))[..] else {
            panic!("{:?}", beams(&message(&ranges)))
        };
        assert!((range - 10.0).abs() < 1e-12, "{range}");
        let endless = LaserSweep { range_max: f64::INFINITY, ..message(&ranges) };
        assert_eq!(beams(&endless)[0], Beam::Unseen);
    }

    #[test]
    fn the_times_of_the_beams_follow_their_order() {
        let flat = Pose3::identity();
        let times = |message: &LaserSweep<'_>| convert(message, &flat, None).unwrap().scan.beam_times();
        assert_eq!(times(&message(&[1.0, 2.0, 3.0])), None);
        let swept = LaserSweep { time_increment: 0.01, ..message(&[1.0, 2.0, 3.0]) };
        assert_eq!(times(&swept), Some(BeamTimes { first_s: 0.0, step_s: 0.01 }));
        let clockwise = LaserSweep { angle_min: 0.5, angle_increment: -0.25, ..swept };
        assert_eq!(times(&clockwise), Some(BeamTimes { first_s: 0.02, step_s: -0.01 }));
        let hours = LaserSweep { time_increment: 3600.0, ..clockwise };
        assert_eq!(times(&hours), None);
    }

    #[test]
    fn impossible_scans_are_refused() {
        let refuse = |message: &LaserSweep<'_>, mount: &Pose3| convert(message, mount, None).unwrap_err();
        let flat = Pose3::from_pose2(Pose2::IDENTITY);
        assert_eq!(refuse(&message(&[]), &flat), "0 ranges, expected 1 to 100000");
        let still = LaserSweep { angle_increment: 0.0, ..message(&[1.0]) };
        assert!(refuse(&still, &flat).starts_with("angle_increment is 0 rad for 1 ranges"));
        let nan = LaserSweep { angle_min: f64::NAN, ..message(&[1.0]) };
        assert!(refuse(&nan, &flat).starts_with("angle_min is NaN rad"));
        let none = LaserSweep { range_max: f64::NAN, ..message(&[1.0]) };
        assert!(refuse(&none, &flat).starts_with("range_max is NaN m"));
        let swapped = LaserSweep { range_min: 12.0, range_max: 0.25, ..message(&[1.0]) };
        assert_eq!(
            refuse(&swapped, &flat),
            "range_min is 12 m and range_max 0.25 m, expected range_min below range_max"
        );
        let degrees = LaserSweep { angle_min: -90.0, ..message(&[1.0]) };
        assert!(refuse(&degrees, &flat).ends_with("it seems to be in degrees"));
        assert_eq!(
            refuse(&message(&[1.0]), &mounted(0.0, 0.0, 0.5, 0.0)),
            "the laser is tilted by 28.6 deg, expected at most 15"
        );
    }
}
