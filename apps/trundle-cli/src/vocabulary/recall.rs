use super::args::{RecallArgs, Sources};
use super::file;
use super::scenery::Scenery;
use super::shots::{self, Photographer, Shot};
use crate::console;
use std::sync::Arc;
use trundle::app::AppError;
use trundle::core::Pose3;
use trundle::vision::{PlaceIndex, Vocabulary};

/// How far the view most like a second look may have been taken from it, m and rad.
const SAME_PLACE: (f64, f64) = (0.75, 25.0 / 180.0 * std::f64::consts::PI);

/// Of a recorded sequence each so manieth frame is a place, and the frame amid two is a second look.
const STRIDE: usize = 10;

/// Places, and second looks at them.
struct Album {
    name: String,
    places: Vec<Shot>,
    looks: Vec<Shot>,
}

/// `trundle vocabulary recall`: a row for each album, a column for each vocabulary.
pub fn run(args: &RecallArgs) -> Result<(), AppError> {
    shots::check(&args.sources)?;
    let vocabularies = vocabularies(args)?;
    let mut head = vec!["recall at 1".to_owned(), "places".to_owned()];
    head.extend(vocabularies.iter().map(|(name, _)| name.clone()));
    let mut rows = vec![head];
    for album in albums(&args.sources, args.common.quiet)? {
        let looks = album.looks.len() as f64;
        let mut row = vec![album.name.clone(), album.places.len().to_string()];
        let share = |vocabulary| format!("{:.1} %", 100.0 * recognised(vocabulary, &album) as f64 / looks);
        row.extend(vocabularies.iter().map(|(_, vocabulary)| share(vocabulary)));
        rows.push(row);
    }
    console::print_table(&rows);
    Ok(())
}

fn vocabularies(args: &RecallArgs) -> Result<Vec<(String, Arc<Vocabulary>)>, AppError> {
    if args.vocabularies.is_empty() {
        return Ok(vec![("built in".to_owned(), Vocabulary::builtin())]);
    }
    let name = |path: &std::path::Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    args.vocabularies.iter().map(|path| Ok((name(path), Arc::new(file::read(path)?)))).collect()
}

fn albums(sources: &Sources, quiet: bool) -> Result<Vec<Album>, AppError> {
    let mut albums = Vec::new();
    for folder in &sources.folders {
        let frames = shots::of_folder(folder, sources, quiet)?;
        if frames.len() <= STRIDE || frames.iter().any(|frame| frame.pose.is_none()) {
            let problem = format!("expected more than {STRIDE} frames with groundtruth.txt");
            return Err(AppError::Input(format!("{}: {problem}", folder.display())));
        }
        albums.push(of_frames(folder.display().to_string(), frames));
    }
    for (name, seed) in shots::scenes(sources) {
        albums.push(of_scene(&Scenery::open(name, seed, sources.z_up)?, seed, sources, quiet)?);
    }
    Ok(albums)
}

fn of_frames(name: String, frames: Vec<Shot>) -> Album {
    let mut album = Album { name, places: Vec::new(), looks: Vec::new() };
    for (i, frame) in frames.into_iter().enumerate() {
        match i % STRIDE {
            0 => album.places.push(frame),
            step if step == STRIDE / 2 => album.looks.push(frame),
            _ => {}
        }
    }
    album
}

fn of_scene(scenery: &Scenery, seed: u64, sources: &Sources, quiet: bool) -> Result<Album, AppError> {
    let mut camera = Photographer::new(scenery, seed, sources.features_per_image as usize)?;
    let mut album = Album { name: scenery.name.clone(), places: Vec::new(), looks: Vec::new() };
    let bar = console::bar(quiet, sources.views as usize);
    for _ in 0..sources.views {
        let (place, shot) = camera.anywhere()?;
        album.places.push(shot);
        album.looks.push(camera.again(place)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(album)
}

/// How many second looks find a view of the same place first.
fn recognised(vocabulary: &Vocabulary, album: &Album) -> usize {
    let mut index = PlaceIndex::default();
    for (place, shot) in (0..).zip(&album.places) {
        index.add(place, &vocabulary.describe(&shot.descriptors).0);
    }
    let is_right = |look: &&Shot| {
        let found = index.query(&vocabulary.describe(&look.descriptors).0, |_| true);
        found.first().is_some_and(|(place, _)| is_same(look.pose, album.places[*place as usize].pose))
    };
    album.looks.iter().filter(is_right).count()
}

fn is_same(a: Option<Pose3>, b: Option<Pose3>) -> bool {
    a.zip(b).is_some_and(|(a, b)| {
        let apart = a.inverse() * b;
        apart.translation.norm() <= SAME_PLACE.0 && apart.angle() <= SAME_PLACE.1
    })
}
