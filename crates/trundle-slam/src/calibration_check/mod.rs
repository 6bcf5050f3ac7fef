//! Wrong settings, found by the images themselves.
//!
//! Problem: a depth scale off by five, another camera's lens or an unregistered depth image does not stop a SLAM; the result is bad
//! without a visible cause. Idea: each of these errors leaves evidence in the images. Depths outside the camera's range, or a distance
//! much longer than the wheels', show a wrong scale. Matched points of a turning camera show focal lengths and distortion, by a
//! self-calibration with the motions eliminated. Depth edges beside the edges of the colour image show a missing registration. Cost: a
//! few ms every fifth frame, until each check has enough data.

pub(crate) mod check;
pub(crate) mod depth_range;
pub(crate) mod issue;
pub(crate) mod model_selection;
pub(crate) mod registration;
pub(crate) mod self_calibration;
pub(crate) mod travelled_distance;
