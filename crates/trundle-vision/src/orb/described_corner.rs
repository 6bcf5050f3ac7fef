//! A corner with its descriptor.

use crate::{Descriptor, ImagePatch};

/// A corner with its descriptor; its position in px of its level.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DescribedCorner {
    pub x: f32,
    pub y: f32,
    pub score: u8,
    pub angle: f32,
    pub descriptor: Descriptor,
    pub patch: ImagePatch,
}
