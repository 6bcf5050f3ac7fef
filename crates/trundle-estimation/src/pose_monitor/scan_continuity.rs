//! Continuity of the scans: whether odometry explains the difference of successive scans.

use std::f64::consts::TAU;
use trundle_core::{Beam, Pose2, Scan, Vector2};

/// Compares each scan with the last one with enough points.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScanContinuity {
    last: Option<KeptScan>,
    /// The last scan before a break; later scans are also compared with this one.
    before_break: Option<KeptScan>,
}

/// Relation of a scan to the previous one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Continuity {
    /// The scan shows the same surfaces, moved by the odometry.
    Continuous,
    /// The scan shows other surfaces: the sensor moved differently from the odometry, or was covered.
    Broken,
    /// The scan shows only a part of the same surfaces.
    Doubtful,
    /// The scans break again and show the surfaces from before the first break: the sensor was covered for a while. A look-alike place
    /// comes into view without a second break.
    Restored,
    /// The previous scans are too old, and have too little in common with this one.
    Unknown,
}

/// A scan with the odometry's pose at its stamp.
#[derive(Debug, Clone)]
struct KeptScan {
    scan: Scan,
    odom_from_base: Pose2,
}

/// Tolerance of a range between two scans \[m\]: noise, and the error of the motion in between. Source: ours.
const RANGE_TOLERANCE_M: f64 = 0.1;
/// Tolerance of a range as a fraction of the range. Source: ours.
const RANGE_TOLERANCE_SHARE: f64 = 0.04;
/// Smallest number of points of a scan in the view of the next one. Source: ours.
const MIN_COMMON_POINTS: usize = 20;
/// Fraction of the common points seen again below which the sequence is broken. Three people who walk past leave 0.7; a displacement in a
/// furnished room leaves 0.04. Source: docs/experiments/pose-monitor.md.
const BROKEN_SHARE: f64 = 0.4;
/// Fraction of the common points seen again below which the sequence is doubtful. A displacement to another wall at the same distance
/// leaves 0.55. Source: docs/experiments/pose-monitor.md.
const DOUBTFUL_SHARE: f64 = 0.65;
/// Smallest fraction of the common points at which a scan shows the surfaces from before the break. Source: ours.
const RESTORED_SHARE: f64 = 0.8;
/// Time without a comparison \[s\] after which the motion in between is unknown. Source: ours, the shortest time to carry a robot away.
const MAX_GAP_S: f64 = 1.0;

impl ScanContinuity {
    /// Compares a scan taken at `odom_from_base` with the previous ones.
    pub(crate) fn add(&mut self, odom_from_base: Pose2, scan: &Scan) -> Continuity {
        if scan.hits().count() < MIN_COMMON_POINTS {
            return self.without_comparison(scan);
        }
        let newest = KeptScan { scan: scan.clone(), odom_from_base };
        let share = self.last.as_ref().and_then(|last| newest.share_of(last));
        let is_broken = share.is_some_and(|share| share < BROKEN_SHARE);
        let as_before = self.before_break.as_ref().and_then(|kept| newest.share_of(kept));
        if is_broken && as_before.is_some_and(|share| share >= RESTORED_SHARE) {
            self.before_break = None;
            self.last = Some(newest);
            return Continuity::Restored;
        }
        let continuity = match share {
            Some(_) if is_broken => Continuity::Broken,
            Some(share) if share < DOUBTFUL_SHARE => Continuity::Doubtful,
            Some(_) => Continuity::Continuous,
            None => self.without_comparison(scan),
        };
        let before = self.last.replace(newest);
        if continuity == Continuity::Broken && self.before_break.is_none() {
            self.before_break = before;
        }
        continuity
    }

    /// Ends a break, after another source gave the pose.
    pub(crate) fn settle(&mut self) {
        self.before_break = None;
    }

    fn without_comparison(&self, scan: &Scan) -> Continuity {
        let is_recent = |last: &KeptScan| scan.stamp() - last.scan.stamp() <= MAX_GAP_S;
        match &self.last {
            Some(last) if !is_recent(last) => Continuity::Unknown,
            _ => Continuity::Continuous,
        }
    }
}

impl KeptScan {
    /// Fraction of an earlier scan's points, moved by odometry, that this scan shows; `None` with few points in its view.
    fn share_of(&self, earlier: &Self) -> Option<f64> {
        let base_from_earlier = self.odom_from_base.inverse() * earlier.odom_from_base;
        let (mut again, mut common) = (0_usize, 0_usize);
        for point in earlier.scan.hits() {
            if let Some(is_again) = shows(&self.scan, base_from_earlier.transform(point)) {
                (again, common) = (again + usize::from(is_again), common + 1);
            }
        }
        (common >= MIN_COMMON_POINTS).then(|| again as f64 / common as f64)
    }
}

/// Difference of ranges above which a point belongs to another surface \[m\]. Source: ours.
const MAX_RESIDUAL_M: f64 = 0.3;

/// Mean difference of ranges between an earlier scan's points, moved by `base_from_earlier`, and a scan, m; each difference at most 0.3 m.
/// `None` with few points in view.
pub(crate) fn mean_residual(earlier: &Scan, base_from_earlier: Pose2, scan: &Scan) -> Option<f64> {
    let residuals = earlier.hits().filter_map(|point| residual(scan, base_from_earlier.transform(point)));
    let (sum, count) = residuals.fold((0.0, 0_usize), |(sum, count), residual| (sum + residual, count + 1));
    (count >= MIN_COMMON_POINTS).then(|| sum / count as f64)
}

fn residual(scan: &Scan, point: Vector2) -> Option<f64> {
    let (range, near) = beams_near(scan, point)?;
    let off = |beam: &Beam| match beam {
        Beam::Hit { range: measured } => Some((measured - range).abs().min(MAX_RESIDUAL_M)),
        Beam::Free { range: free } if *free > range => Some(MAX_RESIDUAL_M),
        _ => None,
    };
    near.iter().filter_map(off).reduce(f64::min)
}

/// Whether a scan has a hit at a point of the base frame; `None` outside its view, or without a measurement there.
fn shows(scan: &Scan, point: Vector2) -> Option<bool> {
    let (range, near) = beams_near(scan, point)?;
    let tolerance = RANGE_TOLERANCE_M.max(RANGE_TOLERANCE_SHARE * range);
    let mut is_measured = false;
    for beam in near {
        match beam {
            Beam::Hit { range: measured } if (measured - range).abs() <= tolerance => return Some(true),
            Beam::Hit { .. } => is_measured = true,
            Beam::Free { range: free } => is_measured |= *free > range + tolerance,
            Beam::Unseen => {}
        }
    }
    is_measured.then_some(false)
}

/// The range of a point of the base frame from the sensor, m, and the three nearest beams; `None` outside the view.
fn beams_near(scan: &Scan, point: Vector2) -> Option<(f64, &[Beam])> {
    let way = point - scan.origin();
    let beam = (way.y.atan2(way.x) - scan.angle_min()).rem_euclid(TAU) / scan.angle_increment();
    let last = scan.beams().len().checked_sub(1)?;
    if beam > last as f64 {
        return None;
    }
    let middle = beam.round() as usize;
    Some((way.norm(), &scan.beams()[middle.saturating_sub(1)..=(middle + 1).min(last)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;

    /// Results for scans of a room every 1/15 s from poses that odometry knows.
    fn continuities(
        room: impl Fn(u32) -> Room,
        poses: impl Fn(u32) -> (Pose2, Pose2),
        count: u32,
    ) -> Vec<Continuity> {
        let mut continuity = ScanContinuity::default();
        let add = |i: u32| {
            let (truth, odom_from_base) = poses(i);
            continuity.add(odom_from_base, &room(i).scan(truth, f64::from(i) / 15.0))
        };
        (0..count).map(add).collect()
    }

    fn driving(i: u32) -> Pose2 {
        Pose2::exp(trundle_core::Vector3::new(0.03, 0.0, 0.08) * f64::from(i))
    }

    #[test]
    fn people_who_walk_past_do_not_break_the_sequence() {
        let walking = |i: u32| {
            let y = -1.2 + f64::from(i) / 15.0;
            Room::with_corner_box().with_person(Vector2::new(0.9, y)).with_person(Vector2::new(1.4, -y))
        };
        let all = continuities(walking, |_| (Pose2::IDENTITY, Pose2::IDENTITY), 36);
        assert!(all.iter().all(|c| *c == Continuity::Continuous), "{all:?}");
    }

    #[test]
    fn a_robot_that_is_put_elsewhere_breaks_the_sequence_once() {
        for carried in [Pose2::new(0.6, 0.3, 0.35), Pose2::new(-0.5, 0.0, 1.5), Pose2::new(0.0, 0.4, -0.6)] {
            let poses = |i: u32| (if i < 8 { driving(i) } else { carried * driving(i) }, driving(i));
            let all = continuities(|_| Room::with_corner_box(), poses, 16);
            let broken: Vec<usize> = (0..16).filter(|i| all[*i] == Continuity::Broken).collect();
            assert_eq!(broken, [8], "{carried:?}");
        }
    }

    #[test]
    fn a_hand_before_the_sensor_is_forgiven_once_the_room_shows_again() {
        let covered = |i: u32| {
            let room = Room::with_corner_box();
            if (5..10).contains(&i) {
                room.with_person(Vector2::new(0.5, 0.0))
                    .with_person(Vector2::new(0.5, 0.3))
                    .with_person(Vector2::new(0.5, -0.3))
            } else {
                room
            }
        };
        let all = continuities(covered, |i| (driving(0), Pose2::new(0.0, 0.0, 1e-3 * f64::from(i))), 14);
        assert_eq!((all[5], all[10]), (Continuity::Broken, Continuity::Restored), "{all:?}");
    }

    #[test]
    fn a_place_that_comes_into_view_and_looks_as_before_does_not_restore_the_sequence() {
        let turns = (0..12).map(|k| -3.0 + 0.5 * f64::from(k));
        for (turn, x) in turns.flat_map(|turn| [-1.0, -0.3, 0.4, 1.1].map(|x| (turn, x))) {
            let odom = |i: u32| Pose2::new(x, 0.4, 0.15 * f64::from(i));
            let truth = |i: u32| if i < 8 { odom(i) } else { odom(i) * Pose2::new(0.0, 0.0, turn) };
            let all = continuities(|_| Room::default(), |i| (truth(i), odom(i)), 90);
            assert!(!all.contains(&Continuity::Restored), "{turn} rad at {x} m: {all:?}");
        }
    }

    #[test]
    fn after_a_second_without_scans_nothing_is_known_of_another_view_and_the_same_view_goes_on() {
        let mut continuity = ScanContinuity::default();
        let room = Room::with_corner_box();
        let away = Pose2::new(0.0, 0.0, 2.0);
        assert_eq!(continuity.add(Pose2::IDENTITY, &room.scan(Pose2::IDENTITY, 0.0)), Continuity::Continuous);
        assert_eq!(continuity.add(Pose2::IDENTITY, &room.scan(Pose2::IDENTITY, 9.0)), Continuity::Continuous);
        assert_eq!(
            continuity.add(away, &room.scan(away, 9.5)),
            Continuity::Continuous,
            "it turned in between"
        );
        assert_eq!(continuity.add(Pose2::IDENTITY, &room.scan(Pose2::IDENTITY, 11.0)), Continuity::Unknown);
    }

    #[test]
    fn the_residual_of_the_true_motion_is_the_smallest() {
        let room = Room::with_corner_box();
        let motion = Pose2::new(0.2, 0.0, 0.3);
        let (earlier, later) = (room.scan(Pose2::IDENTITY, 0.0), room.scan(motion, 1.0));
        let residual = |motion: Pose2| mean_residual(&earlier, motion.inverse(), &later).unwrap();
        let right = residual(motion);
        for wrong in [Pose2::new(0.26, 0.0, 0.3), Pose2::new(0.2, 0.06, 0.3), Pose2::new(0.2, 0.0, 0.26)] {
            assert!(residual(wrong) > right + 0.005, "{wrong:?}: {} against {right}", residual(wrong));
        }
    }
}
