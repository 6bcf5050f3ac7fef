use crate::found::Found;
use crate::ids::KeyframeId;
use crate::places::Place;
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
    let places = tracker.places.places_alike(tracker.map, tracker.words(), |_| true, most);
    tried(places, most, |id| Found::from_keyframe(tracker, id))
}

/// What is found in `most` tries. A place in which nothing was found is tried again by its next keyframe, before others that are as
/// much less like it: where it stands at the edge of what was mapped, few of its keyframes show enough, and a twin would have
/// no rival. (Tries are dealt out as seats are by D'Hondt.)
fn tried<T>(places: Vec<Place>, most: usize, mut find: impl FnMut(KeyframeId) -> Option<T>) -> Vec<T> {
    let mut open: Vec<(Place, usize)> = places.into_iter().map(|place| (place, 0)).collect();
    let mut found = Vec::new();
    for _ in 0..most {
        let hope = |(place, tries): &(Place, usize)| place.similarity / (tries + 1) as f32;
        let is_open = |i: &usize| open[*i].0.members.get(open[*i].1).is_some();
        let by_hope = |a: &usize, b: &usize| hope(&open[*a]).total_cmp(&hope(&open[*b]));
        // Of equal ones, the first.
        let Some(next) = (0..open.len()).rev().filter(is_open).max_by(by_hope) else { break };
        let (place, tries) = &mut open[next];
        match find(place.members[*tries]) {
            Some(at) => {
                found.push(at);
                open.remove(next);
            }
            None => *tries += 1,
        }
    }
    found
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
    fn a_place_is_tried_again_before_what_is_much_less_like_it() {
        let id = KeyframeId::from_index;
        let place = |similarity, members: &[usize]| Place {
            similarity,
            members: members.iter().copied().map(id).collect(),
            around: Vec::new(),
        };
        let places =
            vec![place(0.33, &[1, 2, 3]), place(0.26, &[10, 11]), place(0.05, &[20]), place(0.05, &[21])];
        let tries = |most: usize, found: &[usize]| {
            let mut tries = Vec::new();
            let at = tried(places.clone(), most, |member| {
                tries.push(member.index());
                found.contains(&member.index()).then_some(member.index())
            });
            (tries, at)
        };
        assert_eq!(tries(5, &[10]), (vec![1, 10, 2, 3, 20], vec![10]));
        assert_eq!(tries(5, &[1, 10]), (vec![1, 10, 20, 21], vec![1, 10]), "once found is enough");
        assert_eq!(tries(9, &[]), (vec![1, 10, 2, 11, 3, 20, 21], vec![]));
        assert_eq!(tries(0, &[1]), (vec![], vec![]));
    }

    #[test]
    fn the_most_points_win_unless_another_place_has_nearly_as_many() {
        assert_eq!(unrivalled::<(f64, usize)>(vec![]), None);
        assert_eq!(unrivalled(vec![(0.0, 50), (0.1, 60), (4.0, 40)]), Some((0.1, 60)));
        assert_eq!(unrivalled(vec![(0.0, 50), (4.0, 60)]), None);
        assert_eq!(unrivalled(vec![(0.0, 60), (0.2, 59)]), Some((0.0, 60)));
    }
}
