//! Constraints between keyframes besides landmarks: odometry and the floor.

use crate::ids::KeyframeId;
use crate::map::floor_plane::FloorPlane;
use crate::map::landmark_map::LandmarkMap;
use trundle_optim::PoseConstraint;

/// Constraints of keyframes by odometry and by the floor. Pose i is keyframe `ids[i]` (by rising id); the pose after these is
/// the identity, to which floors are constrained. Constraints between fixed keyframes are left out.
pub(crate) fn odometry_and_floor_constraints(
    map: &LandmarkMap,
    ids: &[KeyframeId],
    is_fixed: impl Fn(usize) -> bool,
) -> Vec<PoseConstraint> {
    let plane = map.floor.and_then(|axis| FloorPlane::of(map, axis));
    let mut constraints = Vec::new();
    for (to, id) in ids.iter().enumerate() {
        let odometry = map.live_keyframe(*id).and_then(|keyframe| keyframe.odometry);
        let from = odometry.and_then(|odometry| ids.binary_search(&odometry.from).ok());
        let from = from.filter(|from| !(is_fixed(to) && is_fixed(*from)));
        constraints.extend(odometry.zip(from).and_then(|(odometry, from)| odometry.constraint(from, to)));
        let plane = plane.filter(|_| !is_fixed(to));
        constraints.extend(plane.and_then(|plane| plane.constraint(map, *id, ids.len(), to)));
    }
    constraints
}
