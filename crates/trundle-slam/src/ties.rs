use crate::floor::Plane;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use trundle_optim::PoseConstraint;

/// What is known of keyframes besides what they see: the ways between them by the wheels, and the floor. Pose i is keyframe
/// `ids[i]` (by rising id), the pose after these is the identity, which floors are tied to. What ties only fixed ones is left
/// out.
pub(crate) fn known_ties(
    map: &LandmarkMap,
    ids: &[KeyframeId],
    is_fixed: impl Fn(usize) -> bool,
) -> Vec<PoseConstraint> {
    let plane = map.floor.and_then(|axis| Plane::of(map, axis));
    let mut ties = Vec::new();
    for (to, id) in ids.iter().enumerate() {
        let rolled = map.live_keyframe(*id).and_then(|keyframe| keyframe.rolled);
        let from = rolled.and_then(|rolled| ids.binary_search(&rolled.from).ok());
        let from = from.filter(|from| !(is_fixed(to) && is_fixed(*from)));
        ties.extend(rolled.zip(from).and_then(|(rolled, from)| rolled.tie(from, to)));
        let plane = plane.filter(|_| !is_fixed(to));
        ties.extend(plane.and_then(|plane| plane.tie(map, *id, ids.len(), to)));
    }
    ties
}
