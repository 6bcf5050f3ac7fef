//! Training of a visual vocabulary on recorded and rendered images.

use super::image_sources::ImageSources;
use super::views::described_views;
use std::fmt;
use std::path::PathBuf;
use trundle_app::vocabulary_file::read_descriptors;
use trundle_app::{AppError, StepProgress};
use trundle_vision::{Descriptor, Vocabulary, VocabularyConfig};

/// Minimum number of descriptors per child of a node. With fewer, a word depends on single images. Source: ours.
const MIN_DESCRIPTORS_PER_CHILD: usize = 2;

/// The images to train on and the shape of the vocabulary.
#[derive(Debug, Clone)]
pub struct VocabularyTraining {
    /// Folders and scenes of images.
    pub sources: ImageSources,
    /// A folder of descriptors that another program made, a file for each image.
    pub descriptors: Option<PathBuf>,
    /// Shape of the vocabulary.
    pub config: VocabularyConfig,
    /// Seed of the clustering.
    pub seed: u64,
}

/// A vocabulary, and the amount of its training data.
#[derive(Debug)]
pub struct TrainedVocabulary {
    /// The vocabulary.
    pub vocabulary: Vocabulary,
    /// Number of images.
    pub images: usize,
    /// Number of descriptors of all images.
    pub descriptors: usize,
}

impl fmt::Display for TrainedVocabulary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = self.vocabulary.word_count();
        write!(f, "{words} words trained from {} descriptors of {} images", self.descriptors, self.images)
    }
}

impl VocabularyTraining {
    /// Trains the vocabulary.
    ///
    /// # Errors
    /// When the shape is invalid, an image cannot be read, or the images have too few descriptors.
    pub fn train(&self, progress: &dyn StepProgress) -> Result<TrainedVocabulary, AppError> {
        let config = self.config.clone().validated()?;
        let images = self.images(progress)?;
        let descriptors: usize = images.iter().map(Vec::len).sum();
        let wanted = MIN_DESCRIPTORS_PER_CHILD * config.branching;
        if descriptors < wanted {
            let problem =
                format!("{descriptors} descriptors in {} images, expected {wanted} or more", images.len());
            return Err(AppError::Input(problem));
        }
        let vocabulary = Vocabulary::train(&images, &config, self.seed)?;
        Ok(TrainedVocabulary { vocabulary, images: images.len(), descriptors })
    }

    /// The descriptors of every image to train on.
    fn images(&self, progress: &dyn StepProgress) -> Result<Vec<Vec<Descriptor>>, AppError> {
        let mut images = self.descriptors.as_deref().map_or(Ok(Vec::new()), read_descriptors)?;
        if self.descriptors.is_none() || self.sources.require_any().is_ok() {
            let views = described_views(&self.sources, progress)?;
            images.extend(views.into_iter().map(|view| view.descriptors));
        }
        Ok(images)
    }
}
