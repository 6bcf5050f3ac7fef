//! The spanning tree over the keyframes of a map, and the loops.

use crate::ids::KeyframeId;
use crate::map::keyframe::Keyframe;
use crate::map::landmark_map::LandmarkMap;
use crate::map::odometry_factor::OdometryFactor;
use trundle_core::Pose3;

impl LandmarkMap {
    /// Adds a new keyframe with observations to the tree. Its parent is the keyframe with the largest number of common landmarks, or the
    /// previous keyframe.
    pub fn add_to_spanning_tree(&mut self, id: KeyframeId) {
        let before = || self.keyframe_ids().take_while(|other| *other < id).last();
        let nearest = self.covisible(id, 1).into_iter().map(|(other, _)| other).find(|other| *other < id);
        if let Some(parent) = nearest.or_else(before) {
            self.set_parent(id, parent);
            self.keyframe_mut(id).tree.shares_no_landmark = nearest.is_none();
        }
    }

    /// Records that two keyframes close a loop, which protects both from removal.
    pub fn add_loop_edge(&mut self, a: KeyframeId, b: KeyframeId) {
        self.keyframe_mut(a).tree.loops.push(b);
        self.keyframe_mut(b).tree.loops.push(a);
    }

    /// The pairs of keyframes that close a loop, the older first, by rising newer one.
    pub fn loops(&self) -> impl Iterator<Item = (KeyframeId, KeyframeId)> + '_ {
        let older = |(id, keyframe): (KeyframeId, &'_ Keyframe)| {
            let pairs = keyframe.tree.loops.iter().filter(move |other| **other < id);
            pairs.map(|other| (*other, id)).collect::<Vec<_>>()
        };
        self.keyframes().flat_map(older)
    }

    /// Removes a keyframe and all its observations. Its children and the frames relative to it go to its parent. The root is never removed.
    /// Returns whether the keyframe was removed.
    pub fn remove_keyframe(&mut self, id: KeyframeId) -> bool {
        let Some(parent) = self.live_keyframe(id).and_then(|k| k.tree.parent) else { return false };
        let seen: Vec<_> = self.keyframe(id).landmarks.iter().flatten().copied().collect();
        seen.into_iter().for_each(|landmark| self.unobserve(landmark, id));
        let Some(gone) = self.keyframes.remove(id.index()) else { return false };
        self.grid.remove(id, gone.visual_from_camera.translation);
        self.join_odometry_over(id, gone.odometry);
        let parent_from_gone = self.keyframe(parent).visual_from_camera.inverse() * gone.visual_from_camera;
        self.removed.insert(id, (parent, parent_from_gone));
        for ward in &gone.tree.successor_of {
            if let Some((successor, successor_from_ward)) = self.removed.get_mut(ward) {
                (*successor, *successor_from_ward) =
                    (parent, (parent_from_gone * *successor_from_ward).renormalized());
            }
        }
        let tree = &mut self.keyframe_mut(parent).tree;
        tree.children.retain(|child| *child != id);
        tree.successor_of.push(id);
        tree.successor_of.extend(gone.tree.successor_of);
        for child in gone.tree.children {
            self.set_parent(child, parent);
            self.keyframe_mut(child).tree.shares_no_landmark |= gone.tree.shares_no_landmark;
        }
        true
    }

    /// Joins the odometry to and from a removed keyframe.
    fn join_odometry_over(&mut self, gone: KeyframeId, before: Option<OdometryFactor>) {
        let next = |(id, keyframe): (KeyframeId, &Keyframe)| {
            Some((id, keyframe.odometry.filter(|r| r.from == gone)?))
        };
        let found: Vec<(KeyframeId, OdometryFactor)> = self.keyframes().filter_map(next).collect();
        for (id, odometry) in found {
            self.keyframe_mut(id).odometry = before.map(|before| before.then(&odometry));
        }
    }

    /// Present pose of a keyframe, also of a removed one.
    pub fn visual_from_keyframe(&self, id: KeyframeId) -> Pose3 {
        let (successor, successor_from_keyframe) = self.resolve(id);
        self.keyframe(successor).visual_from_camera * successor_from_keyframe
    }

    /// The keyframe, or the successor of a removed one, with the keyframe's pose relative to it.
    pub fn resolve(&self, id: KeyframeId) -> (KeyframeId, Pose3) {
        self.removed.get(&id).copied().unwrap_or((id, Pose3::identity()))
    }

    /// Makes a keyframe the child of another one.
    pub fn set_parent(&mut self, child: KeyframeId, parent: KeyframeId) {
        self.keyframe_mut(child).tree.parent = Some(parent);
        self.keyframe_mut(parent).tree.children.push(child);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::landmark_map::tests::assert_consistent;
    use crate::testing::blank_frame;
    use nalgebra::Vector6;
    use trundle_core::Vector3;

    fn along(x: f64) -> Pose3 {
        Pose3::exp(Vector6::new(x, 0.0, 0.1 * x, 0.0, 0.2 * x, 0.0))
    }

    /// Four keyframes in a row; each shares a landmark with the previous one.
    fn chain() -> (LandmarkMap, Vec<KeyframeId>) {
        let mut map = LandmarkMap::default();
        let mut ids: Vec<KeyframeId> = Vec::new();
        for i in 0..4 {
            let id = map.add_keyframe(blank_frame(4), along(f64::from(i)));
            let landmark = map.add_landmark(Vector3::z());
            map.observe(landmark, id, 0);
            if let Some(last) = ids.last() {
                map.observe(landmark, *last, 1);
            }
            map.add_to_spanning_tree(id);
            ids.push(id);
        }
        (map, ids)
    }

    #[test]
    fn a_removed_keyframe_leaves_children_and_frames_to_its_parent() {
        let (mut map, k) = chain();
        assert_eq!(map.keyframe(k[3]).tree.parent, Some(k[2]));
        assert!(map.remove_keyframe(k[2]) && map.remove_keyframe(k[1]));
        assert!(!map.remove_keyframe(k[1]), "gone already");
        assert!(!map.remove_keyframe(k[0]), "the root stays");
        assert_consistent(&map);
        assert_eq!(map.keyframe_ids().collect::<Vec<_>>(), vec![k[0], k[3]]);
        assert_eq!(map.keyframe(k[0]).tree.children, vec![k[3]]);
        assert_eq!(map.keyframe(k[3]).tree.parent, Some(k[0]));
        let moved = along(-0.7);
        map.move_keyframe(k[0], moved);
        for (i, id) in k.iter().enumerate().take(3) {
            let gap = (moved * along(i as f64)).inverse() * map.visual_from_keyframe(*id);
            assert!(gap.log().norm() < 1e-12, "{id}");
        }
        assert_eq!(map.add_keyframe(blank_frame(1), along(9.0)).index(), 4);
    }
}
