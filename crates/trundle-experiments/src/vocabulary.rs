//! Images for training a visual vocabulary, and the share of places that a vocabulary recognises.

mod image_sources;
mod placement;
mod recall;
mod rendered_scene;
mod views;

pub use image_sources::{ImageSources, IndexRange};
pub use recall::{PlaceRecall, recall_table};
pub use views::{DescribedView, described_views};
