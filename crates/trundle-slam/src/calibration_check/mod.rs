//! Wrong settings, noticed from the images themselves.
//!
//! Problem: a depth scale off by five, another camera's lens or an unregistered depth image does not stop a SLAM: it only
//! makes it bad, and nobody knows why. Idea: each of these leaves a trace that the right settings do not. Depths that no
//! depth camera measures, or a way much longer than the wheels', tell a wrong scale; matched points of a turning camera
//! tell focal lengths and distortion (a self-calibration by least squares, the motions eliminated); edges of depth that lie
//! beside the edges of the picture tell a missing registration. Cost: a few ms every fifth frame, only until each check has
//! enough to judge by.

pub(crate) mod check;
pub(crate) mod depth_range;
pub(crate) mod issue;
pub(crate) mod model_selection;
pub(crate) mod registration;
pub(crate) mod self_calibration;
pub(crate) mod travelled_distance;
