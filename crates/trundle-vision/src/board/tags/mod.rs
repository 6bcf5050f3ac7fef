//! Square markers of the family tag36h11 in a grey image.
//!
//! Problem: the corners of each marker to a tenth of a pixel, and the marker's number. Idea \[Olson11\]: a marker is a dark square with 36
//! cells inside. The codes differ in at least 11 cells in every orientation. Dark regions with a convex outline of four corners are
//! candidates. Curves are fitted to the edges, their intersections are the corners, and the cells give the number. Cost: O(pixels).
//!
//! | \[Olson11\] | here |
//! |---|---|
//! | quad | `Quad`, clockwise in the image |
//! | line segment | `SideCurve`, of second order: a lens bends lines |
//! | payload | `TagCode` |

mod codes;
mod components;
mod decode;
mod quad;
mod side_curve;
mod tag;
mod threshold;

pub use codes::{TAG_CELLS, TAG_COUNT, tag_cells};
pub use tag::Tag;

use super::smooth_image::SmoothImage;
use components::dark_components;
use decode::{Decoded, decode};
use quad::{outline_quad, refined_quad};
use threshold::dark_mask;
use trundle_core::GrayImage;

/// Content of an image.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TagSearch {
    /// Markers of the family, by id.
    pub tags: Vec<Tag>,
    /// For each black square without a marker's code: number of cells that differ from the nearest marker.
    pub unknown: Vec<u32>,
    /// Markers of the family that appear mirrored.
    pub mirrored: usize,
}

/// Blur before the search, px: against noise; more would break the border of small markers. Source: ours.
const SEARCH_BLUR_PX: f32 = 0.4;
/// Blur before the refinement, px: more would mix the inner cells of a tilted marker into its edge. Source: ours.
const REFINEMENT_BLUR_PX: f32 = 0.3;

/// The markers of tag36h11 in an image. Markers with a side below 16 px, or with a hidden corner, are not found.
#[must_use]
pub fn find_tags(image: &GrayImage) -> TagSearch {
    let smooth = SmoothImage::new(image, REFINEMENT_BLUR_PX);
    let mask = dark_mask(&SmoothImage::new(image, SEARCH_BLUR_PX));
    let mut found = TagSearch::default();
    for component in dark_components(mask, image.width()) {
        let Some(quad) = outline_quad(&component).and_then(|quad| refined_quad(&smooth, quad)) else {
            continue;
        };
        match decode(&smooth, &quad) {
            Some(Decoded::Tag(tag)) => found.tags.push(tag),
            Some(Decoded::Mirrored) => found.mirrored += 1,
            Some(Decoded::Unknown { wrong_cells }) => found.unknown.push(wrong_cells),
            None => {}
        }
    }
    found.tags.sort_by_key(|tag| tag.id);
    found
}
