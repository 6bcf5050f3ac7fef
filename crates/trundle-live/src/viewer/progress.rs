//! State that the two halves of a viewer's link share.

use std::sync::atomic::{AtomicBool, AtomicU64};

/// State that the two halves of a viewer's link share.
#[derive(Debug, Default)]
pub struct ViewProgress {
    /// Number of the last view that the page has drawn.
    pub seen: AtomicU64,
    /// Whether the page requests images.
    pub wants_images: AtomicBool,
    /// Whether the page requests the depth of images.
    pub wants_depth: AtomicBool,
    /// Whether the page requests the visual map.
    pub wants_visual_map: AtomicBool,
}
