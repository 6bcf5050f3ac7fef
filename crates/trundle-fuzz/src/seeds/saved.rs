//! Files that trundle itself saves.

use std::collections::BTreeMap;
use trundle::core::{
    ColorImage, DepthImage, Distortion, MapAnnotations, OccupancyGrid, PinholeCamera, Pose2, RgbdImage, Stamp,
};
use trundle::runtime::{Checkpoint, Mission, MissionState, Task};
use trundle::slam::{RgbdSlam, SlamConfig};
use trundle::vision::{Descriptor, Vocabulary, VocabularyConfig};

/// The camera of the saved maps.
pub(crate) fn small_camera() -> PinholeCamera {
    PinholeCamera::new((320, 240), (260.0, 260.0), (159.5, 119.5), Distortion::default())
        .expect("invariant: the camera is valid")
}

/// The map of a flat wall of random blocks, seen once and again.
pub fn visual_map() -> Vec<Vec<u8>> {
    let mut slam =
        RgbdSlam::new(small_camera(), SlamConfig::default()).expect("invariant: the settings are valid");
    for i in 0..4 {
        slam.step(&wall(i), None);
    }
    vec![slam.save()]
}

fn wall(i: i64) -> RgbdImage {
    let shade = |x: usize, y: usize| (((x / 6) * 73_856_093) ^ ((y / 6) * 19_349_663)) % 251;
    let color = ColorImage::from_fn(320, 240, |x, y| [shade(x, y) as u8; 3]);
    let depth = DepthImage::filled(320, 240, 2.0);
    RgbdImage::new(Stamp::from_nanos(33_000_000 * i), color, depth)
        .expect("invariant: the images are as large")
}

/// A floor map, a mission and no visual map.
pub fn checkpoint() -> Vec<Vec<u8>> {
    let mission = Mission::new(vec![Task::Explore, Task::go(Pose2::new(1.5, -2.0, 0.25)), Task::Return]);
    let grid = OccupancyGrid::from_ascii(0.05, "###\n#.#\n#??").expect("invariant: the map is valid");
    let mission = MissionState::new(mission.expect("invariant: the goals are finite"));
    vec![
        Checkpoint {
            visual: Vec::new(),
            visual_maps: BTreeMap::new(),
            grid,
            mission,
            station: None,
            annotations: MapAnnotations::default(),
        }
        .to_bytes(),
    ]
}

/// A vocabulary of a few words.
pub fn vocabulary() -> Vec<Vec<u8>> {
    vec![trained().to_bytes()]
}

/// The vocabulary as text of DBoW2.
pub fn dbow2() -> Vec<Vec<u8>> {
    vec![trained().to_dbow2_text().into_bytes()]
}

fn trained() -> Vocabulary {
    let images: Vec<Vec<Descriptor>> =
        (1..9_u64).map(|i| (1..9).map(|j| descriptor(i * 31 + j)).collect()).collect();
    let config = VocabularyConfig::of_tree(3, 2);
    Vocabulary::train(&images, &config, 1).expect("invariant: there are descriptors")
}

fn descriptor(seed: u64) -> Descriptor {
    Descriptor(std::array::from_fn(|i| seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(17 * i as u32)))
}
