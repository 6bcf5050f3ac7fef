//! The features of recorded frames and of rendered views.

use super::image_sources::ImageSources;
use super::placement::{CameraPlacement, PlacementSampler};
use super::rendered_scene::RenderedScene;
use std::path::Path;
use trundle_app::{AppError, StepProgress};
use trundle_core::{Pose3, Stamp, gray_from_color};
use trundle_io::{TUM_DEPTH_SCALE, TumSequence};
use trundle_sim::{Renderer, RgbdSensor, SimConfig, View};
use trundle_vision::{Descriptor, OrbConfig, OrbExtractor};

/// Share of a view's pixels without any surface. A view with more is drawn again. Source: ours.
const MAX_EMPTY_SHARE: f64 = 0.3;

/// Features of a view. A view with fewer, as of a blank wall, is drawn again. Source: ours.
const MIN_VIEW_FEATURES: usize = 100;

/// Maximum number of attempts for one view with surfaces and features. After these the scene is refused. Source: ours.
const MAX_DRAWN_VIEWS: usize = 100;

/// The features of an image.
pub struct DescribedView {
    /// `world_from_camera`, if it is known.
    pub pose: Option<Pose3>,
    /// Descriptors of the view.
    pub descriptors: Vec<Descriptor>,
}

/// All images of the sources: folder by folder, scene by scene, seed by seed.
///
/// # Errors
/// When no source is given, a folder or scene cannot be read, or a scene has no placement for a camera.
pub fn described_views(
    sources: &ImageSources,
    progress: &dyn StepProgress,
) -> Result<Vec<DescribedView>, AppError> {
    sources.require_any()?;
    let mut views = Vec::new();
    for folder in &sources.folders {
        views.extend(folder_views(folder, sources, progress)?);
    }
    for (name, seed) in sources.seeded_scenes() {
        let scene = RenderedScene::open(name, seed, sources.z_up)?;
        let mut renderer = ViewRenderer::new(&scene, seed, sources.features_per_image)?;
        progress.begin(Some(sources.views));
        progress.message(&scene.name);
        for _ in 0..sources.views {
            views.push(renderer.draw()?.1);
            progress.advance();
        }
        progress.end();
    }
    Ok(views)
}

/// The requested frames of a TUM RGB-D folder.
pub fn folder_views(
    folder: &Path,
    sources: &ImageSources,
    progress: &dyn StepProgress,
) -> Result<Vec<DescribedView>, AppError> {
    // The depth is not used: its scale does not matter.
    let sequence = TumSequence::open(folder, TUM_DEPTH_SCALE, TumSequence::MAX_DIFFERENCE)?;
    let first = sources.frames.map_or(0, |span| span.first as usize);
    let end = sources.frames.map_or(sequence.len(), |span| sequence.len().min(span.last as usize + 1));
    if first >= end {
        let problem = format!("{}: no frame {first}, it has {} frames", folder.display(), sequence.len());
        return Err(AppError::Input(problem));
    }
    let mut orb = extractor(sources.features_per_image)?;
    progress.begin(Some(end - first));
    let view = |i: usize| {
        let image = sequence.load(i).map_err(|error| AppError::Input(error.to_string()))?;
        let descriptors = orb.extract(&gray_from_color(image.color())).descriptors;
        progress.advance();
        Ok(DescribedView { pose: true_pose(&sequence, image.stamp()), descriptors })
    };
    let views = (first..end).map(view).collect();
    progress.end();
    views
}

/// The true pose nearest in time.
fn true_pose(sequence: &TumSequence, stamp: Stamp) -> Option<Pose3> {
    let nearest = sequence.ground_truth()?.iter().min_by_key(|(at, _)| at.nanos.abs_diff(stamp.nanos));
    nearest.map(|(_, pose)| *pose)
}

fn extractor(features: usize) -> Result<OrbExtractor, AppError> {
    let mut config = OrbConfig::default();
    config.features = features;
    Ok(OrbExtractor::new(config)?)
}

/// Renders noisy views of a scene by Kinect V2 and v1 alternately.
pub struct ViewRenderer<'s> {
    scene: &'s RenderedScene,
    placements: PlacementSampler,
    cameras: Vec<Camera>,
    /// Index of the camera of the last view.
    turn: usize,
    /// Number of views, the seed of their noise.
    taken: u64,
}

struct Camera {
    renderer: Renderer,
    sensor: RgbdSensor,
    view: View,
    orb: OrbExtractor,
}

impl<'s> ViewRenderer<'s> {
    /// Views, placements and noise depend on the seed alone.
    pub fn new(scene: &'s RenderedScene, seed: u64, features: usize) -> Result<Self, AppError> {
        let camera = |config: SimConfig| {
            let renderer = Renderer::new(config.camera)?;
            let sensor = RgbdSensor::new(config.depth_noise, config.color_noise, seed)?;
            Ok(Camera { view: renderer.blank(), renderer, sensor, orb: extractor(features)? })
        };
        let cameras: Result<Vec<Camera>, AppError> =
            [SimConfig::kinect_v2(), SimConfig::kinect_v1()].map(camera).into_iter().collect();
        let placements = PlacementSampler::of(&scene.world, seed)?;
        Ok(Self { scene, placements, cameras: cameras?, turn: 0, taken: 0 })
    }

    /// A view with surfaces and features from a drawn placement, by the next camera.
    pub fn draw(&mut self) -> Result<(CameraPlacement, DescribedView), AppError> {
        let nowhere =
            || AppError::Input(format!("{}: found no place with something to see", self.scene.name));
        self.turn = (self.turn + 1) % self.cameras.len();
        for _ in 0..MAX_DRAWN_VIEWS {
            let placement = self.placements.draw().ok_or_else(nowhere)?;
            let view = self.at(placement)?;
            if self.empty_share() <= MAX_EMPTY_SHARE && view.descriptors.len() >= MIN_VIEW_FEATURES {
                return Ok((placement, view));
            }
        }
        Err(nowhere())
    }

    /// A second view from near a placement, by the same camera.
    pub fn draw_near(&mut self, placement: CameraPlacement) -> Result<DescribedView, AppError> {
        let near = self.placements.near(placement);
        self.at(near)
    }

    fn at(&mut self, placement: CameraPlacement) -> Result<DescribedView, AppError> {
        let Camera { renderer, sensor, view, orb } = &mut self.cameras[self.turn];
        let pose = placement.camera();
        renderer.render(&self.scene.snapshot(), &pose, view);
        let image = sensor.expose(view, Stamp::default(), self.taken)?;
        self.taken += 1;
        let descriptors = orb.extract(&gray_from_color(image.color())).descriptors;
        Ok(DescribedView { pose: Some(pose), descriptors })
    }

    /// Share of the pixels of the last view without any surface.
    fn empty_share(&self) -> f64 {
        let view = &self.cameras[self.turn].view;
        view.depth.iter().filter(|depth| **depth == 0.0).count() as f64 / view.depth.len() as f64
    }
}
