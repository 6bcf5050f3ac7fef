//! SLAM on a TUM RGB-D folder: the camera's pose at each image.
//!
//! `cargo run --release --example 01_slam_a_folder -- FOLDER`; without a folder, five simulated images of a room.

#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;
use std::path::Path;
use trundle::core::{RgbdImage, RobotBody, SensorEvent};
use trundle::io::{CameraModel, TumSequence};
use trundle::sim::{Scene, SimConfig, Simulator};
use trundle::slam::{RgbdSlam, SlamConfig};

/// Largest difference between the stamps of a colour image and its depth image \[s\]. Source: the default of TUM's tools.
const MAX_STAMP_DIFFERENCE_S: f64 = 0.02;

/// Tracks the images and prints a pose each.
///
/// # Errors
/// When the folder cannot be read.
pub fn main() -> Result<(), Box<dyn Error>> {
    match std::env::args().nth(1).filter(|argument| Path::new(argument).is_dir()) {
        Some(folder) => track_folder(Path::new(&folder)),
        None => track_simulated_images(),
    }
}

fn track_folder(folder: &Path) -> Result<(), Box<dyn Error>> {
    let camera = CameraModel::read(&folder.join("camera.toml"))?;
    let sequence = TumSequence::open(folder, camera.depth_scale, MAX_STAMP_DIFFERENCE_S)?;
    let mut slam = RgbdSlam::new(camera.camera, SlamConfig::default())?;
    for image in sequence.frames() {
        print_pose(&mut slam, &image?);
    }
    Ok(())
}

fn track_simulated_images() -> Result<(), Box<dyn Error>> {
    let config = SimConfig::default();
    let mut slam = RgbdSlam::new(config.camera, SlamConfig::default())?;
    let mut body = Simulator::new(Scene::by_name("room", 1)?, config, 1)?;
    let mut images = 0;
    while let Some(event) = body.next_event()? {
        if let SensorEvent::Rgbd(image) = event {
            assert!(print_pose(&mut slam, &image), "a furnished room is tracked");
            images += 1;
        }
        if images == 5 {
            break;
        }
    }
    Ok(())
}

/// Tracks one image. Returns whether the camera was located.
fn print_pose(slam: &mut RgbdSlam, image: &RgbdImage) -> bool {
    let report = slam.step(image, None);
    let position = report.visual_from_camera.translation;
    println!(
        "{} {:?} at ({:.3}, {:.3}, {:.3}) m",
        image.stamp(),
        report.tracking,
        position.x,
        position.y,
        position.z
    );
    report.tracking.is_located()
}
