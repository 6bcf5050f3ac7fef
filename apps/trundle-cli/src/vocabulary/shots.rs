use super::args::Sources;
use super::places::{Place, Places};
use super::scenery::Scenery;
use crate::console;
use std::path::Path;
use trundle::app::AppError;
use trundle::core::{Pose3, Stamp, gray_from_color};
use trundle::io::{TUM_DEPTH_SCALE, TumSequence};
use trundle::sim::{Renderer, RgbdSensor, SimConfig, View};
use trundle::vision::{Descriptor, OrbConfig, OrbExtractor};

/// A view into the void where more than this part of the pixels shows nothing.
const MOST_VOID: f64 = 0.3;

/// A view with fewer features is of a blank wall, and nobody could say which.
const FEWEST_FEATURES: usize = 100;

/// Views drawn for one that shows something, at most.
const MOST_DRAWN: usize = 100;

/// What an image shows.
pub struct Shot {
    /// `world_from_camera`, where it is known.
    pub pose: Option<Pose3>,
    /// Its features.
    pub descriptors: Vec<Descriptor>,
}

/// All images of the sources: folder by folder, scene by scene, seed by seed.
///
/// # Errors
/// When there is no source, a folder or scene cannot be read, or a scene has no place to look from.
pub fn of(sources: &Sources, quiet: bool) -> Result<Vec<Shot>, AppError> {
    check(sources)?;
    let mut shots = Vec::new();
    for folder in &sources.folders {
        shots.extend(of_folder(folder, sources, quiet)?);
    }
    for (name, seed) in scenes(sources) {
        let scenery = Scenery::open(name, seed, sources.z_up)?;
        let mut camera = Photographer::new(&scenery, seed, sources.features_per_image as usize)?;
        let bar = console::bar(quiet, sources.views as usize);
        bar.set_message(scenery.name.clone());
        for _ in 0..sources.views {
            shots.push(camera.anywhere()?.1);
            bar.inc(1);
        }
        bar.finish_and_clear();
    }
    Ok(shots)
}

/// Says when there is nothing to look at.
pub fn check(sources: &Sources) -> Result<(), AppError> {
    if sources.folders.is_empty() && sources.scenes.is_empty() {
        return Err(AppError::Input("no images: name a TUM RGB-D folder or a --scene".to_owned()));
    }
    Ok(())
}

/// The scenes asked for, with every seed: a file looks the same, from other places.
pub fn scenes(sources: &Sources) -> impl Iterator<Item = (&str, u64)> {
    let seeds = sources.seeds.first..=sources.seeds.last;
    sources.scenes.iter().flat_map(move |name| seeds.clone().map(move |seed| (name.as_str(), seed)))
}

/// The frames asked for of a TUM RGB-D folder.
pub fn of_folder(folder: &Path, sources: &Sources, quiet: bool) -> Result<Vec<Shot>, AppError> {
    // The depth is not looked at: its scale does not matter.
    let sequence = TumSequence::open(folder, TUM_DEPTH_SCALE, TumSequence::MAX_DIFFERENCE)?;
    let first = sources.frames.map_or(0, |span| span.first as usize);
    let end = sources.frames.map_or(sequence.len(), |span| sequence.len().min(span.last as usize + 1));
    if first >= end {
        let problem = format!("{}: no frame {first}, it has {} frames", folder.display(), sequence.len());
        return Err(AppError::Input(problem));
    }
    let mut orb = extractor(sources.features_per_image as usize)?;
    let bar = console::bar(quiet, end - first);
    let shot = |i: usize| {
        let image = sequence.load(i).map_err(|error| AppError::Input(error.to_string()))?;
        let descriptors = orb.extract(&gray_from_color(image.color())).descriptors;
        bar.inc(1);
        Ok(Shot { pose: true_pose(&sequence, image.stamp()), descriptors })
    };
    let shots = (first..end).map(shot).collect();
    bar.finish_and_clear();
    shots
}

/// The true pose nearest in time.
fn true_pose(sequence: &TumSequence, stamp: Stamp) -> Option<Pose3> {
    let nearest = sequence.ground_truth()?.iter().min_by_key(|(at, _)| at.nanos.abs_diff(stamp.nanos));
    nearest.map(|(_, pose)| *pose)
}

fn extractor(features: usize) -> Result<OrbExtractor, AppError> {
    Ok(OrbExtractor::new(OrbConfig { features, ..OrbConfig::default() })?)
}

/// Takes noisy pictures of a scenery by Kinect V2 and v1 in turn.
pub struct Photographer<'s> {
    scenery: &'s Scenery,
    places: Places,
    cameras: Vec<Camera>,
    /// The camera whose turn it is.
    turn: usize,
    /// Pictures taken, by which their noise differs.
    taken: u64,
}

struct Camera {
    renderer: Renderer,
    sensor: RgbdSensor,
    view: View,
    orb: OrbExtractor,
}

impl<'s> Photographer<'s> {
    /// The pictures, places and noise depend on the seed alone.
    pub fn new(scenery: &'s Scenery, seed: u64, features: usize) -> Result<Self, AppError> {
        let camera = |config: SimConfig| {
            let renderer = Renderer::new(config.camera)?;
            let sensor = RgbdSensor::new(config.depth_noise, config.color_noise, seed)?;
            Ok(Camera { view: renderer.blank(), renderer, sensor, orb: extractor(features)? })
        };
        let cameras: Result<Vec<Camera>, AppError> =
            [SimConfig::kinect_v2(), SimConfig::kinect_v1()].map(camera).into_iter().collect();
        let places = Places::of(&scenery.world, seed)?;
        Ok(Self { scenery, places, cameras: cameras?, turn: 0, taken: 0 })
    }

    /// A picture from a chance place where there is something to see, by the next camera.
    pub fn anywhere(&mut self) -> Result<(Place, Shot), AppError> {
        let nowhere =
            || AppError::Input(format!("{}: found no place with something to see", self.scenery.name));
        self.turn = (self.turn + 1) % self.cameras.len();
        for _ in 0..MOST_DRAWN {
            let place = self.places.draw().ok_or_else(nowhere)?;
            let shot = self.at(place)?;
            if self.void() <= MOST_VOID && shot.descriptors.len() >= FEWEST_FEATURES {
                return Ok((place, shot));
            }
        }
        Err(nowhere())
    }

    /// A second look at a place, by the same camera.
    pub fn again(&mut self, place: Place) -> Result<Shot, AppError> {
        let near = self.places.near(place);
        self.at(near)
    }

    fn at(&mut self, place: Place) -> Result<Shot, AppError> {
        let Camera { renderer, sensor, view, orb } = &mut self.cameras[self.turn];
        let pose = place.camera();
        renderer.render(&self.scenery.snapshot(), &pose, view);
        let image = sensor.expose(view, Stamp::default(), self.taken)?;
        self.taken += 1;
        let descriptors = orb.extract(&gray_from_color(image.color())).descriptors;
        Ok(Shot { pose: Some(pose), descriptors })
    }

    /// The part of the picture just taken that shows nothing.
    fn void(&self) -> f64 {
        let view = &self.cameras[self.turn].view;
        view.depth.iter().filter(|depth| **depth == 0.0).count() as f64 / view.depth.len() as f64
    }
}
