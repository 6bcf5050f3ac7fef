//! The pose of a frame relative to a keyframe.

use crate::ids::KeyframeId;
use crate::map::landmark_map::LandmarkMap;
use trundle_core::{Pose3, Stamp};

/// A frame's pose relative to a keyframe, so that the pose follows refinements of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AnchoredPose {
    pub stamp: Stamp,
    /// The reference keyframe; `None` before the first keyframe.
    pub reference: Option<KeyframeId>,
    /// Pose in the reference keyframe; `visual_from_camera` without a reference.
    pub reference_from_camera: Pose3,
}

impl AnchoredPose {
    pub fn new(
        stamp: Stamp,
        reference: Option<KeyframeId>,
        visual_from_camera: Pose3,
        map: &LandmarkMap,
    ) -> Self {
        let reference_from_visual = reference.map(|id| map.visual_from_keyframe(id).inverse());
        let reference_from_camera = reference_from_visual.unwrap_or_default() * visual_from_camera;
        Self { stamp, reference, reference_from_camera }
    }

    /// `visual_from_camera` of a pose without a reference.
    pub fn fixed_pose(&self) -> Option<Pose3> {
        self.reference.is_none().then_some(self.reference_from_camera)
    }

    /// The pose by the present map. A removed reference is replaced by its successor.
    pub fn visual_from_camera(&self, map: &LandmarkMap) -> Pose3 {
        let visual_from_reference = self.reference.map(|id| map.visual_from_keyframe(id));
        (visual_from_reference.unwrap_or_default() * self.reference_from_camera).renormalized()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::map_of_one_view;
    use nalgebra::Vector6;

    #[test]
    fn a_pose_moves_along_with_its_keyframe() {
        let (mut map, reference) = map_of_one_view(3);
        let pose = Pose3::exp(Vector6::new(0.1, 0.2, 0.3, 0.1, 0.0, 0.2));
        let anchored = AnchoredPose::new(Stamp::default(), Some(reference), pose, &map);
        let correction = Pose3::exp(Vector6::new(0.0, 0.05, 0.0, 0.02, 0.0, 0.0));
        map.move_keyframe(reference, correction);
        let gap = anchored.visual_from_camera(&map).inverse() * (correction * pose);
        assert!(gap.log().norm() < 1e-12);
    }
}
