//! Fusion of odometry, visual poses and scan matches: the localizer.

pub(crate) mod belief;
pub(crate) mod config;
pub(crate) mod correction;
pub(crate) mod divergence_check;
pub(crate) mod localizer;
pub(crate) mod map_uncertainty;
pub(crate) mod measurement_buffer;
pub(crate) mod pose_uncertainty;
pub(crate) mod visual_frame;
