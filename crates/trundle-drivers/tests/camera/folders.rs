//! Folders with new files: pairs in order, unfinished files, and missing ones.

use crate::fixtures::info;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use trundle_drivers::camera::pipe::{FolderCamera, header_line};
use trundle_drivers::camera::pixels::{color_from_raw, depth_from_raw};
use trundle_drivers::camera::{CameraFrame, DepthCamera, PixelFormat};

const LONG: Duration = Duration::from_secs(20);
const SHORT: Duration = Duration::from_millis(60);

fn folder(is_live: bool) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut info = info();
    info.is_live = is_live;
    fs::write(folder.path().join("camera.json"), header_line(&info).unwrap()).unwrap();
    fs::create_dir(folder.path().join("color")).unwrap();
    fs::create_dir(folder.path().join("depth")).unwrap();
    folder
}

fn color_png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_pixel(8, 6, image::Rgb([10, 20, 30]));
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn depth_png(millimetres: u16) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::ImageBuffer::from_pixel(4, 4, image::Luma([millimetres]));
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn write_pair(folder: &Path, stamp: i64) {
    fs::write(folder.join(format!("color/{stamp}.png")), color_png()).unwrap();
    fs::write(folder.join(format!("depth/{stamp}.png")), depth_png(1000 + stamp as u16)).unwrap();
}

/// Stamp and depth of the first pixel \[mm\] of a frame.
fn summary(frame: &CameraFrame) -> (i64, u32) {
    let (mut color, mut depth) = Default::default();
    color_from_raw(&frame.color, &mut color).unwrap();
    depth_from_raw(&frame.depth, 0.001, &mut depth).unwrap();
    assert_eq!(color.data(), [[10, 20, 30]; 48]);
    (frame.color.device_stamp.nanos, (depth.data()[0] * 1000.0).round() as u32)
}

#[test]
fn pairs_come_in_the_order_of_their_stamps_and_a_recording_ends() {
    let folder = folder(false);
    [30, 4, 200].into_iter().for_each(|stamp| write_pair(folder.path(), stamp));
    fs::write(folder.path().join("color/5.png.part"), b"unfinished").unwrap();
    fs::write(folder.path().join("color/notes.txt"), b"no image").unwrap();
    let mut camera = FolderCamera::open(folder.path()).unwrap();
    let mut found = Vec::new();
    while let Some(frame) = camera.next_frame(LONG).unwrap() {
        found.push(summary(&frame));
    }
    assert!(camera.has_ended());
    assert_eq!(found, [(4, 1004), (30, 1030), (200, 1200)]);
}

#[test]
fn files_are_read_when_they_appear_and_unfinished_ones_are_not() {
    let folder = folder(true);
    let mut camera = FolderCamera::open(folder.path()).unwrap();
    assert_eq!(camera.next_frame(SHORT).unwrap(), None);
    let path = folder.path().join("depth/7.png");
    fs::write(folder.path().join("color/7.png"), color_png()).unwrap();
    fs::write(&path, b"").unwrap();
    assert_eq!(camera.next_frame(SHORT).unwrap(), None, "an empty file is not finished");
    fs::write(folder.path().join("depth/7.tmp"), depth_png(1007)).unwrap();
    fs::rename(folder.path().join("depth/7.tmp"), &path).unwrap();
    assert_eq!(summary(&camera.next_frame(LONG).unwrap().unwrap()), (7, 1007));
    assert!(!camera.has_ended());
}

#[test]
fn a_missing_image_is_waited_for_and_then_its_pair_is_dropped() {
    let folder = folder(true);
    fs::write(folder.path().join("color/5.png"), color_png()).unwrap();
    write_pair(folder.path(), 6);
    let wait = Duration::from_millis(300);
    let mut camera = FolderCamera::with_pair_wait(folder.path(), wait).unwrap();
    let started = Instant::now();
    assert_eq!(summary(&camera.next_frame(LONG).unwrap().unwrap()), (6, 1006));
    assert!(started.elapsed() >= wait, "it waited {:?}", started.elapsed());
    assert_eq!((camera.counts().frames, camera.counts().dropped), (1, 1));
    fs::write(folder.path().join("depth/5.png"), depth_png(5)).unwrap();
    assert_eq!(camera.next_frame(SHORT).unwrap(), None, "a pair that comes too late stays dropped");
}

#[test]
fn a_broken_image_costs_one_frame() {
    let folder = folder(true);
    write_pair(folder.path(), 1);
    write_pair(folder.path(), 2);
    fs::write(folder.path().join("color/1.png"), b"this is not a PNG").unwrap();
    let mut camera = FolderCamera::open(folder.path()).unwrap();
    let error = camera.next_frame(LONG).unwrap_err();
    assert!(error.is_of_one_frame() && error.to_string().contains("color/1.png is not readable"), "{error}");
    assert_eq!(summary(&camera.next_frame(LONG).unwrap().unwrap()), (2, 1002));
}

#[test]
fn a_jpeg_is_delivered_as_it_is() {
    let folder = folder(true);
    write_pair(folder.path(), 3);
    fs::remove_file(folder.path().join("color/3.png")).unwrap();
    fs::write(folder.path().join("color/3.jpg"), b"\xff\xd8 anything").unwrap();
    let mut camera = FolderCamera::open(folder.path()).unwrap();
    let frame = camera.next_frame(LONG).unwrap().unwrap();
    assert_eq!((frame.color.format, &frame.color.bytes[..]), (PixelFormat::Mjpg, &b"\xff\xd8 anything"[..]));
}

#[test]
fn a_folder_without_its_description_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let error = FolderCamera::open(folder.path()).unwrap_err().to_string();
    assert!(error.contains("camera.json cannot be read"), "{error}");
}
