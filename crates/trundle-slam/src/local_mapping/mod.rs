//! New keyframes and landmarks, and the removal of useless ones.

pub(crate) mod config;
pub(crate) mod keyframe_culling;
pub(crate) mod keyframe_policy;
pub(crate) mod local_mapper;
pub(crate) mod reference_patch_storage;
pub(crate) mod triangulation;
