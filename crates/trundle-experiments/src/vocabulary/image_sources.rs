//! Sources of images: recorded folders and simulated scenes.

use crate::IndexRange;
use std::path::PathBuf;
use trundle_app::AppError;

/// Recorded folders and simulated scenes.
#[derive(Debug, Clone)]
pub struct ImageSources {
    /// TUM RGB-D folders.
    pub folders: Vec<PathBuf>,
    /// Frames of each folder, from 0; `None` for all.
    pub frames: Option<IndexRange>,
    /// Scenes, built in or glTF files.
    pub scenes: Vec<String>,
    /// Seeds of the scenes and of the camera placements.
    pub seeds: IndexRange,
    /// Number of views per scene and seed.
    pub views: usize,
    /// Whether glTF files have z up.
    pub z_up: bool,
    /// Maximum number of ORB features per image.
    pub features_per_image: usize,
}

impl ImageSources {
    /// Refuses sources without any image.
    ///
    /// # Errors
    /// When neither a folder nor a scene is given.
    pub fn require_any(&self) -> Result<(), AppError> {
        if self.folders.is_empty() && self.scenes.is_empty() {
            return Err(AppError::Input("no images: name a TUM RGB-D folder or a --scene".to_owned()));
        }
        Ok(())
    }

    /// Each scene with each seed. For a glTF file only the camera placements depend on the seed.
    pub(super) fn seeded_scenes(&self) -> impl Iterator<Item = (&str, u64)> {
        let seeds = self.seeds.first..=self.seeds.last;
        self.scenes.iter().flat_map(move |name| seeds.clone().map(move |seed| (name.as_str(), seed)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(scenes: &[&str], (first, last): (u64, u64)) -> ImageSources {
        ImageSources {
            folders: Vec::new(),
            frames: None,
            scenes: scenes.iter().map(|&name| name.to_owned()).collect(),
            seeds: IndexRange { first, last },
            views: 1,
            z_up: false,
            features_per_image: 100,
        }
    }

    #[test]
    fn every_scene_is_taken_with_every_seed() {
        let pairs = sources(&["room", "house"], (3, 4));
        let pairs: Vec<_> = pairs.seeded_scenes().collect();
        assert_eq!(pairs, [("room", 3), ("room", 4), ("house", 3), ("house", 4)]);
    }

    #[test]
    fn sources_without_images_are_refused() {
        assert!(sources(&["room"], (1, 1)).require_any().is_ok());
        assert!(sources(&[], (1, 1)).require_any().unwrap_err().to_string().starts_with("no images"));
    }
}
