//! Images for training a visual vocabulary, and the share of places that a vocabulary recognises.

mod image_sources;
mod placement;
mod recall;
mod rendered_scene;
mod training;
mod views;

pub use image_sources::ImageSources;
pub use recall::{PlaceRecall, recall_table};
pub use training::{TrainedVocabulary, VocabularyTraining};
pub use views::{DescribedView, described_views};
