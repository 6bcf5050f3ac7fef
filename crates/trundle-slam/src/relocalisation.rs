use crate::found::Found;
use crate::ids::KeyframeId;
use crate::tracker::Tracker;
use trundle_core::Pose3;

/// Two poses nearer to each other than this are one place: m, and rad.
const SAME_PLACE: (f64, f64) = (0.3, 0.3);
/// A second place with more than this part of the first one's points makes both doubtful: that of a second match which
/// is nearly as near \[Lowe04\].
const RIVAL: f64 = 0.7;

/// Where a camera is that nothing is known of: the keyframes that look alike, each tried in full. Believed is the place
/// with the most points that agree, unless a second one elsewhere has nearly as many, as rooms that look the same do.
pub(crate) fn relocalise(tracker: &Tracker, is_asked_for: impl Fn(KeyframeId) -> bool) -> Option<Found> {
    let most = tracker.config.relocalisation_keyframes;
    let candidates = tracker.places.alike(tracker.map, tracker.words(), is_asked_for, most);
    let found = candidates.into_iter().filter_map(|id| Found::from_keyframe(tracker, id)).collect();
    unrivalled(found)
}

/// The place with the most points, of equal ones the first; `None` when there is none, or a rival.
fn unrivalled(mut found: Vec<Found>) -> Option<Found> {
    found.sort_by_key(|found| std::cmp::Reverse(found.inliers()));
    let mut found = found.into_iter();
    let best = found.next()?;
    let pose = best.fix.visual_from_camera();
    let is_rival = |other: &Found| {
        other.inliers() as f64 > RIVAL * best.inliers() as f64
            && !is_same_place(pose, other.fix.visual_from_camera())
    };
    (!found.any(|other| is_rival(&other))).then_some(best)
}

/// Whether two poses are of one place.
pub(crate) fn is_same_place(a: Pose3, b: Pose3) -> bool {
    let offset = a.inverse() * b;
    offset.translation.norm() < SAME_PLACE.0 && offset.angle() < SAME_PLACE.1
}
