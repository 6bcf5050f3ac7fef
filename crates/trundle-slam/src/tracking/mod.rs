//! The pose of each frame.

pub(crate) mod config;
pub(crate) mod last_frame;
pub(crate) mod local_map;
pub(crate) mod localized_frame;
pub(crate) mod odometry_conflict;
pub(crate) mod pose_gate;
pub(crate) mod relocalisation;
pub(crate) mod tracker;
pub(crate) mod tracking_state;
pub(crate) mod tracking_status;
