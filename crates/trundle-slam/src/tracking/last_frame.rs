//! The last frame that was located, from which the next one is tracked.

use crate::frame::rgbd_frame::Frame;
use crate::ids::LandmarkId;
use crate::map::anchored_pose::AnchoredPose;
use crate::map::landmark_map::LandmarkMap;
use crate::matching::reference_frame::ReferenceFrame;

/// A frame whose pose was found.
#[derive(Debug)]
pub(crate) struct LastFrame {
    pub frame: Frame,
    /// The landmark of each feature.
    pub landmarks: Vec<Option<LandmarkId>>,
    pub anchored: AnchoredPose,
}

impl LastFrame {
    /// The frame with its pose by the present map.
    pub fn as_reference(&self, map: &LandmarkMap) -> ReferenceFrame<'_> {
        let visual_from_camera = self.anchored.visual_from_camera(map);
        ReferenceFrame { frame: &self.frame, landmarks: &self.landmarks, visual_from_camera }
    }
}
