//! Place recognition rate of a vocabulary: recall at 1.

use super::image_sources::ImageSources;
use super::rendered_scene::RenderedScene;
use super::views::{DescribedView, ViewRenderer, folder_views};
use std::sync::Arc;
use trundle_app::{AppError, StepProgress};
use trundle_core::Pose3;
use trundle_vision::{PlaceIndex, Vocabulary};

/// Largest distance between two views of one place \[m\]. Source: ours.
const MAX_SAME_PLACE_M: f64 = 0.75;
/// Largest angle between two views of one place \[rad\]. Source: ours.
const MAX_SAME_PLACE_RAD: f64 = 25.0 / 180.0 * std::f64::consts::PI;

/// Number of frames from one place to the next; the frame halfway between is the second view. Source: ours.
const PLACE_STRIDE_FRAMES: usize = 10;

/// First and second views of places.
struct ViewPairs {
    name: String,
    places: Vec<DescribedView>,
    second_views: Vec<DescribedView>,
}

/// Recall of each vocabulary in one source of images.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceRecall {
    /// The source: a folder, or a scene with its seed.
    pub name: String,
    /// Number of places.
    pub places: usize,
    /// For each vocabulary, the fraction of second views whose most similar view shows the same place, 0 to 1.
    pub recall: Vec<f64>,
}

impl PlaceRecall {
    /// Measures `vocabularies` on each folder and on each scene with each seed.
    ///
    /// # Errors
    /// When no source is given, a folder has no ground truth or too few frames, or a scene cannot be rendered.
    pub fn measure(
        vocabularies: &[Arc<Vocabulary>],
        sources: &ImageSources,
        progress: &dyn StepProgress,
    ) -> Result<Vec<Self>, AppError> {
        sources.require_any()?;
        Ok(view_pairs(sources, progress)?.iter().map(|pairs| Self::of(vocabularies, pairs)).collect())
    }

    fn of(vocabularies: &[Arc<Vocabulary>], pairs: &ViewPairs) -> Self {
        let count = pairs.second_views.len() as f64;
        let recall = |vocabulary: &Arc<Vocabulary>| recognised(vocabulary, pairs) as f64 / count;
        let recall = vocabularies.iter().map(recall).collect();
        Self { name: pairs.name.clone(), places: pairs.places.len(), recall }
    }
}

/// The table: a row for each source, a column for each vocabulary.
#[must_use]
pub fn recall_table(vocabularies: &[String], measured: &[PlaceRecall]) -> Vec<Vec<String>> {
    let head = ["recall at 1".to_owned(), "places".to_owned()];
    let head = head.into_iter().chain(vocabularies.iter().cloned()).collect();
    let row = |measured: &PlaceRecall| {
        let shares = measured.recall.iter().map(|share| format!("{:.1} %", 100.0 * share));
        [measured.name.clone(), measured.places.to_string()].into_iter().chain(shares).collect()
    };
    std::iter::once(head).chain(measured.iter().map(row)).collect()
}

fn view_pairs(sources: &ImageSources, progress: &dyn StepProgress) -> Result<Vec<ViewPairs>, AppError> {
    let mut all = Vec::new();
    for folder in &sources.folders {
        let frames = folder_views(folder, sources, progress)?;
        if frames.len() <= PLACE_STRIDE_FRAMES || frames.iter().any(|frame| frame.pose.is_none()) {
            let problem = format!("expected more than {PLACE_STRIDE_FRAMES} frames with groundtruth.txt");
            return Err(AppError::Input(format!("{}: {problem}", folder.display())));
        }
        all.push(of_frames(folder.display().to_string(), frames));
    }
    for (name, seed) in sources.seeded_scenes() {
        all.push(of_scene(&RenderedScene::open(name, seed, sources.z_up)?, seed, sources, progress)?);
    }
    Ok(all)
}

fn of_frames(name: String, frames: Vec<DescribedView>) -> ViewPairs {
    let mut pairs = ViewPairs { name, places: Vec::new(), second_views: Vec::new() };
    for (i, frame) in frames.into_iter().enumerate() {
        match i % PLACE_STRIDE_FRAMES {
            0 => pairs.places.push(frame),
            step if step == PLACE_STRIDE_FRAMES / 2 => pairs.second_views.push(frame),
            _ => {}
        }
    }
    pairs
}

fn of_scene(
    scene: &RenderedScene,
    seed: u64,
    sources: &ImageSources,
    progress: &dyn StepProgress,
) -> Result<ViewPairs, AppError> {
    let mut camera = ViewRenderer::new(scene, seed, sources.features_per_image)?;
    let mut pairs = ViewPairs { name: scene.name.clone(), places: Vec::new(), second_views: Vec::new() };
    progress.begin(Some(sources.views));
    for _ in 0..sources.views {
        let (placement, view) = camera.draw()?;
        pairs.places.push(view);
        pairs.second_views.push(camera.draw_near(placement)?);
        progress.advance();
    }
    progress.end();
    Ok(pairs)
}

/// The number of second views whose most similar view shows the same place.
fn recognised(vocabulary: &Vocabulary, pairs: &ViewPairs) -> usize {
    let mut index = PlaceIndex::default();
    for (place, view) in (0..).zip(&pairs.places) {
        index.add(place, &vocabulary.describe(&view.descriptors).0);
    }
    let is_right = |second: &&DescribedView| {
        let found = index.query(&vocabulary.describe(&second.descriptors).0, |_| true);
        found.first().is_some_and(|(place, _)| is_same(second.pose, pairs.places[*place as usize].pose))
    };
    pairs.second_views.iter().filter(is_right).count()
}

fn is_same(a: Option<Pose3>, b: Option<Pose3>) -> bool {
    a.zip(b).is_some_and(|(a, b)| {
        let apart = a.inverse() * b;
        apart.translation.norm() <= MAX_SAME_PLACE_M && apart.angle() <= MAX_SAME_PLACE_RAD
    })
}
