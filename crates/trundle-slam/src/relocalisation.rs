use crate::found::Found;
use crate::ids::KeyframeId;
use crate::places::{Place, Worded};
use crate::tracker::Tracker;
use std::collections::BTreeSet;
use trundle_core::Pose3;

/// Two poses nearer to each other than this are one place: m, and rad.
const SAME_PLACE: (f64, f64) = (0.3, 0.3);
/// A second place with more than this part of the first one's points makes both doubtful: that of a second match which
/// is nearly as near \[Lowe04\].
const RIVAL: f64 = 0.7;

/// Where a camera may be that was not followed: the keyframes that look alike, each tried in full but for aligning features. Among them are places that are
/// not to be believed by themselves, and yet make others doubtful.
pub(crate) fn relocalise(tracker: &Tracker) -> Vec<Found> {
    let most = tracker.config.relocalisation_keyframes;
    let mut asked = BTreeSet::new();
    let mut find = |places| {
        tried(places, most, |id| asked.insert(id).then(|| Found::from_keyframe(tracker, id)).flatten())
    };
    let mut found = find(tracker.places.places_alike(tracker.map, tracker.words(), |_| true, most));
    let twins = best(&found).and_then(|i| found[i].recognised).map(|id| twins(tracker, id, most));
    found.extend(twins.into_iter().flat_map(find));
    found
}

/// Places that look like that of a keyframe: of a room and its twin an image may show what looks more like the wrong one, but the two
/// look like each other.
fn twins(tracker: &Tracker, keyframe: KeyframeId, most: usize) -> Vec<Place> {
    let Some(Worded { words, .. }) = tracker.places.worded(tracker.map, keyframe) else { return vec![] };
    let here: BTreeSet<KeyframeId> =
        tracker.map.covisible(keyframe, 1).into_iter().map(|(id, _)| id).chain([keyframe]).collect();
    tracker.places.places_alike(tracker.map, words, |id| !here.contains(&id), most)
}

/// Which is the certain one with the most points, of equal ones the first.
fn best<T: Placed>(found: &[T]) -> Option<usize> {
    (0..found.len()).rev().filter(|i| found[*i].is_certain()).max_by_key(|i| found[*i].points())
}

/// What is found in `most` tries. A place in which nothing certain was found is tried again by its next keyframe, before others that are as
/// much less like it: where it stands at the edge of what was mapped, few of its keyframes show enough, and a twin would have
/// no rival. (Tries are dealt out as seats are by D'Hondt.)
fn tried<T: Placed>(
    places: Vec<Place>,
    most: usize,
    mut find: impl FnMut(KeyframeId) -> Option<T>,
) -> Vec<T> {
    let mut open: Vec<(Place, usize)> = places.into_iter().map(|place| (place, 0)).collect();
    let mut found = Vec::new();
    for _ in 0..most {
        let hope = |(place, tries): &(Place, usize)| place.similarity / (tries + 1) as f32;
        let is_open = |i: &usize| open[*i].0.members.get(open[*i].1).is_some();
        let by_hope = |a: &usize, b: &usize| hope(&open[*a]).total_cmp(&hope(&open[*b]));
        // Of equal ones, the first.
        let Some(next) = (0..open.len()).rev().filter(is_open).max_by(by_hope) else { break };
        let (place, tries) = &mut open[next];
        let at = find(place.members[*tries]);
        *tries += 1;
        if at.as_ref().is_some_and(T::is_certain) {
            open.remove(next);
        }
        found.extend(at);
    }
    found
}

/// Where a camera may be, and how many points say so.
pub(crate) trait Placed {
    fn pose(&self) -> Pose3;
    fn points(&self) -> usize;
    /// Whether what should be there is seen there.
    fn looks_right(&self) -> bool;
    /// Whether they may be believed, if there is no rival.
    fn is_certain(&self) -> bool;
}

impl Placed for Found {
    fn pose(&self) -> Pose3 {
        self.fix.visual_from_camera()
    }

    fn points(&self) -> usize {
        self.points
    }

    fn looks_right(&self) -> bool {
        self.looks_right
    }

    fn is_certain(&self) -> bool {
        self.is_certain
    }
}

/// The certain place with the most points, of equal ones the first; `None` when there is none, or when a second one elsewhere has
/// nearly as many, as rooms that look the same do, or one that does not look quite right has more.
pub(crate) fn unrivalled<T: Placed>(mut found: Vec<T>) -> Option<T> {
    let i = best(&found)?;
    let best = &found[i];
    let share = |other: &T| if other.looks_right() { RIVAL } else { 1.0 };
    let is_near = |other: &T| other.points() as f64 > share(other) * best.points() as f64;
    let is_rival = |other: &T| is_near(other) && !is_same_place(best.pose(), other.pose());
    (!found.iter().any(is_rival)).then(|| found.swap_remove(i))
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

    /// How certain a place is.
    #[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
    enum Says {
        Little,
        LooksRight,
        Certain,
    }
    use Says::{Certain, Little, LooksRight};

    /// Where along a line, and how many points.
    impl Placed for (f64, usize, Says) {
        fn pose(&self) -> Pose3 {
            Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * self.0)
        }

        fn points(&self) -> usize {
            self.1
        }

        fn looks_right(&self) -> bool {
            self.2 >= LooksRight
        }

        fn is_certain(&self) -> bool {
            self.2 == Certain
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
        let tries = |most: usize, certain: &[usize], doubtful: &[usize]| {
            let mut tries = Vec::new();
            let at = tried(places.clone(), most, |member| {
                let id = member.index();
                tries.push(id);
                let says = if certain.contains(&id) { Certain } else { Little };
                (says == Certain || doubtful.contains(&id)).then_some((0.0, id, says))
            });
            (tries, at.into_iter().map(|(_, id, _)| id).collect::<Vec<_>>())
        };
        assert_eq!(tries(5, &[10], &[]), (vec![1, 10, 2, 3, 20], vec![10]));
        assert_eq!(tries(5, &[1, 10], &[]), (vec![1, 10, 20, 21], vec![1, 10]), "once found is enough");
        assert_eq!(tries(5, &[10], &[1, 3]), (vec![1, 10, 2, 3, 20], vec![1, 10, 3]), "if it is certain");
        assert_eq!(tries(9, &[], &[]), (vec![1, 10, 2, 11, 3, 20, 21], vec![]));
        assert_eq!(tries(0, &[1], &[]), (vec![], vec![]));
    }

    #[test]
    fn the_most_points_win_unless_another_place_has_nearly_as_many() {
        assert_eq!(unrivalled::<(f64, usize, Says)>(vec![]), None);
        let best = |found: &[(f64, usize)]| {
            unrivalled(found.iter().map(|(x, points)| (*x, *points, Certain)).collect())
                .map(|(x, n, _)| (x, n))
        };
        assert_eq!(best(&[(0.0, 50), (0.1, 60), (4.0, 40)]), Some((0.1, 60)));
        assert_eq!(best(&[(0.0, 50), (4.0, 60)]), None);
        assert_eq!(best(&[(0.0, 60), (0.2, 59)]), Some((0.0, 60)));
    }

    #[test]
    fn a_doubtful_place_is_a_rival_and_no_winner() {
        let certain = (0.0, 50, Certain);
        assert_eq!(unrivalled(vec![(4.0, 51, Little), certain]), None);
        assert_eq!(unrivalled(vec![(4.0, 40, LooksRight), certain]), None);
        assert_eq!(unrivalled(vec![(0.1, 90, Little), certain, (4.0, 49, Little)]), Some(certain));
        assert_eq!(unrivalled(vec![(0.0, 90, LooksRight)]), None);
    }
}
