use crate::found::Found;
use crate::tracker::Tracker;
use trundle_core::Pose3;

/// Two poses nearer to each other than this are one place: m, and rad.
const SAME_PLACE: (f64, f64) = (0.3, 0.3);
/// A second place with more than this part of the first one's points makes both doubtful: that of a second match which
/// is nearly as near \[Lowe04\].
const RIVAL: f64 = 0.7;

/// Where a camera may be that was not followed: the keyframes that look alike, each tried in full.
pub(crate) fn relocalise(tracker: &Tracker) -> Vec<Found> {
    let most = tracker.config.relocalisation_keyframes;
    let candidates = tracker.places.alike(tracker.map, tracker.words(), |_| true, most);
    candidates.into_iter().filter_map(|id| Found::from_keyframe(tracker, id)).collect()
}

/// Where a camera may be, and how many points say so.
pub(crate) trait Placed {
    fn pose(&self) -> Pose3;
    fn points(&self) -> usize;
}

impl Placed for Found {
    fn pose(&self) -> Pose3 {
        self.fix.visual_from_camera()
    }

    fn points(&self) -> usize {
        self.inliers()
    }
}

/// The place with the most points, of equal ones the first; `None` when there is none, or when a second one elsewhere has
/// nearly as many, as rooms that look the same do.
pub(crate) fn unrivalled<T: Placed>(mut found: Vec<T>) -> Option<T> {
    found.sort_by_key(|found| std::cmp::Reverse(found.points()));
    let mut found = found.into_iter();
    let best = found.next()?;
    let is_near = |other: &T| other.points() as f64 > RIVAL * best.points() as f64;
    let is_rival = |other: T| is_near(&other) && !is_same_place(best.pose(), other.pose());
    (!found.any(is_rival)).then_some(best)
}

/// Whether two poses are of one place.
pub(crate) fn is_same_place(a: Pose3, b: Pose3) -> bool {
    let offset = a.inverse() * b;
    offset.translation.norm() < SAME_PLACE.0 && offset.angle() < SAME_PLACE.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector3;

    impl Placed for (f64, usize) {
        fn pose(&self) -> Pose3 {
            Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * self.0)
        }

        fn points(&self) -> usize {
            self.1
        }
    }

    #[test]
    fn the_most_points_win_unless_another_place_has_nearly_as_many() {
        assert_eq!(unrivalled::<(f64, usize)>(vec![]), None);
        assert_eq!(unrivalled(vec![(0.0, 50), (0.1, 60), (4.0, 40)]), Some((0.1, 60)));
        assert_eq!(unrivalled(vec![(0.0, 50), (4.0, 60)]), None);
        assert_eq!(unrivalled(vec![(0.0, 60), (0.2, 59)]), Some((0.0, 60)));
    }
}
