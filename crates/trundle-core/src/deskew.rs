//! Scans in motion: each beam is moved to the pose of the base at the time of its measurement.

use crate::{BeamTimes, Pose2, Scan, Stamp};

/// Number of stretches of a scan within which the base moves at constant velocity: for a laser of 5 Hz a stretch is 25 ms. Source: ours,
/// the period of wheel readings.
const STRETCH_COUNT: usize = 8;

/// The scan as if all its beams were measured at its stamp, by the poses of the base over its beams' times.
///
/// A scan without beam times, or with a beam at whose time no pose is known, is returned as it is.
#[must_use]
pub fn deskewed(scan: Scan, odom_from_base: impl Fn(Stamp) -> Option<Pose2>) -> Scan {
    let Some(times) = scan.beam_times() else { return scan };
    let Some(motion) = Motion::new(&scan, times, odom_from_base) else { return scan };
    scan.deskewed(|time_s| motion.at(time_s))
}

/// Poses of the base in its frame at the stamp, at even times.
struct Motion {
    first_s: f64,
    stretch_s: f64,
    base_from_base_at: Vec<Pose2>,
}

impl Motion {
    fn new(scan: &Scan, times: BeamTimes, odom_from_base: impl Fn(Stamp) -> Option<Pose2>) -> Option<Self> {
        let last_s = times.of(scan.beams().len().saturating_sub(1));
        let (first_s, stretch_s) = (times.first_s, (last_s - times.first_s) / STRETCH_COUNT as f64);
        let base_from_odom = odom_from_base(scan.stamp())?.inverse();
        let pose = |k: usize| {
            let stamp = scan.stamp().after(first_s + k as f64 * stretch_s);
            Some(base_from_odom * odom_from_base(stamp)?)
        };
        let base_from_base_at = (0..=STRETCH_COUNT).map(pose).collect::<Option<_>>()?;
        Some(Self { first_s, stretch_s, base_from_base_at })
    }

    fn at(&self, time_s: f64) -> Pose2 {
        if self.stretch_s == 0.0 {
            return self.base_from_base_at[0];
        }
        let place = ((time_s - self.first_s) / self.stretch_s).clamp(0.0, STRETCH_COUNT as f64);
        let k = (place as usize).min(STRETCH_COUNT - 1);
        self.base_from_base_at[k].interpolate(&self.base_from_base_at[k + 1], place - k as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Beam, Vector2};

    /// A scan of 181 beams over half a turn and 0.1 s, of a wall at x = 3 from a base that turns by 1 rad/s, its last beam at the stamp.
    fn wall() -> (Scan, impl Fn(Stamp) -> Option<Pose2>) {
        let odom_from_base = |stamp: Stamp| Some(Pose2::new(0.0, 0.0, stamp.as_secs()));
        let (end, times) = (Stamp::from_nanos(0), BeamTimes { first_s: -0.1, step_s: 0.1 / 180.0 });
        let beam = |i: i32| {
            let heading = times.of(i as usize) + f64::from(i - 90).to_radians();
            if heading.cos() > 0.2 { Beam::Hit { range: 3.0 / heading.cos() } } else { Beam::Unseen }
        };
        let beams = (0..181).map(beam).collect();
        let scan = Scan::new(end, Vector2::zeros(), -std::f64::consts::FRAC_PI_2, 1_f64.to_radians(), beams);
        (scan.unwrap().with_beam_times(times).unwrap(), odom_from_base)
    }

    #[test]
    fn a_wall_that_a_turning_laser_saw_is_straight() {
        let (scan, odom_from_base) = wall();
        let off = |scan: &Scan| scan.hits().map(|hit| (hit.x - 3.0).abs()).fold(0.0, f64::max);
        assert!(off(&scan) > 0.3, "{}", off(&scan));
        assert!(off(&deskewed(scan, odom_from_base)) < 1e-5);
    }

    #[test]
    fn a_scan_without_a_pose_at_each_beam_stays_as_it_is() {
        let (scan, odom_from_base) = wall();
        let odom_from_base = &odom_from_base;
        let known_from = |first: Stamp| move |stamp: Stamp| odom_from_base(stamp).filter(|_| stamp >= first);
        assert_eq!(deskewed(scan.clone(), known_from(Stamp::from_nanos(-50_000_000))), scan);
        assert_ne!(deskewed(scan.clone(), known_from(Stamp::from_nanos(-100_000_001))), scan);
    }
}
