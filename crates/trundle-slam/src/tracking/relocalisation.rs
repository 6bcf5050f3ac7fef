//! Pose of a camera that was not tracked, by complete localization against each similar keyframe.

use crate::ids::KeyframeId;
use crate::place_recognition::keyframe_index::KeyframeGroup;
use crate::place_recognition::place_hypothesis::{PlaceHypothesis, best_hypothesis};
use crate::tracking::localized_frame::LocalizedFrame;
use crate::tracking::tracker::Tracker;
use std::collections::BTreeSet;

/// The poses by similar keyframes, before alignment. Uncertain poses are included, since they make others ambiguous.
pub(crate) fn relocalize(tracker: &Tracker) -> Vec<LocalizedFrame> {
    let max_tries = tracker.config.relocalisation_keyframes;
    let mut tried = BTreeSet::new();
    let mut find = |groups| {
        try_groups(groups, max_tries, |id| {
            tried.insert(id).then(|| LocalizedFrame::from_keyframe(tracker, id)).flatten()
        })
    };
    let groups = tracker.place_index.similar_groups(tracker.map, tracker.bow(), |_| true, max_tries);
    let mut found = find(groups);
    let best = best_hypothesis(&found).and_then(|i| found[i].recognized);
    let look_alikes = best.map(|id| look_alikes(tracker, id, max_tries));
    found.extend(look_alikes.into_iter().flat_map(find));
    found
}

/// Groups elsewhere that are similar to a keyframe. An image can be more similar to the wrong one of two look-alike rooms, but the rooms
/// are similar to each other.
fn look_alikes(tracker: &Tracker, keyframe: KeyframeId, max_groups: usize) -> Vec<KeyframeGroup> {
    let Some(own) = tracker.place_index.frame_bow(tracker.map, keyframe) else { return vec![] };
    let here: BTreeSet<KeyframeId> =
        tracker.map.covisible(keyframe, 1).into_iter().map(|(id, _)| id).chain([keyframe]).collect();
    tracker.place_index.similar_groups(tracker.map, own.bow, |id| !here.contains(&id), max_groups)
}

/// The hypotheses of a number of tries, distributed over the groups as seats by D'Hondt's method. A group without a certain result is tried
/// again with its next keyframe, before much less similar groups. At the edge of the map few keyframes of a group match, and a look-alike
/// would have no competitor.
fn try_groups<T: PlaceHypothesis>(
    groups: Vec<KeyframeGroup>,
    max_tries: usize,
    mut find: impl FnMut(KeyframeId) -> Option<T>,
) -> Vec<T> {
    let mut open: Vec<(KeyframeGroup, usize)> = groups.into_iter().map(|group| (group, 0)).collect();
    let mut found = Vec::new();
    for _ in 0..max_tries {
        let priority = |(group, tries): &(KeyframeGroup, usize)| group.similarity / (tries + 1) as f32;
        let is_open = |i: &usize| open[*i].0.members.get(open[*i].1).is_some();
        let by_priority = |a: &usize, b: &usize| priority(&open[*a]).total_cmp(&priority(&open[*b]));
        // The first of equal priorities.
        let Some(next) = (0..open.len()).rev().filter(is_open).max_by(by_priority) else { break };
        let (group, tries) = &mut open[next];
        let hypothesis = find(group.members[*tries]);
        *tries += 1;
        if hypothesis.as_ref().is_some_and(T::is_certain) {
            open.remove(next);
        }
        found.extend(hypothesis);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Certainty::{Certain, Implausible};

    #[test]
    fn a_group_is_tried_again_before_a_much_less_similar_one() {
        let id = KeyframeId::from_index;
        let group = |similarity, members: &[usize]| KeyframeGroup {
            similarity,
            members: members.iter().copied().map(id).collect(),
            covisible: Vec::new(),
        };
        let groups =
            vec![group(0.33, &[1, 2, 3]), group(0.26, &[10, 11]), group(0.05, &[20]), group(0.05, &[21])];
        let tries = |max: usize, certain: &[usize], doubtful: &[usize]| {
            let mut tries = Vec::new();
            let at = try_groups(groups.clone(), max, |member| {
                let id = member.index();
                tries.push(id);
                let certainty = if certain.contains(&id) { Certain } else { Implausible };
                (certainty == Certain || doubtful.contains(&id)).then_some((0.0, id, certainty))
            });
            (tries, at.into_iter().map(|(_, id, _)| id).collect::<Vec<_>>())
        };
        assert_eq!(tries(5, &[10], &[]), (vec![1, 10, 2, 3, 20], vec![10]));
        assert_eq!(tries(5, &[1, 10], &[]), (vec![1, 10, 20, 21], vec![1, 10]), "once found is enough");
        assert_eq!(tries(5, &[10], &[1, 3]), (vec![1, 10, 2, 3, 20], vec![1, 10, 3]), "if it is certain");
        assert_eq!(tries(9, &[], &[]), (vec![1, 10, 2, 11, 3, 20, 21], vec![]));
        assert_eq!(tries(0, &[1], &[]), (vec![], vec![]));
    }
}
