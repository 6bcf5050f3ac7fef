//! Keyframes similar to an image, by a visual vocabulary.

pub(crate) mod bow;
pub(crate) mod consistency_check;
pub(crate) mod keyframe_index;
pub(crate) mod pending_relocalisations;
pub(crate) mod place_hypothesis;
