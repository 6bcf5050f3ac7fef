//! The Kinect v1: fakenect plays a folder that the test writes. fakenect reads its folder from an environment variable and is loaded once per
//! process, so each test runs itself again in a child process.

use crate::support::{debian, in_child, skip};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trundle_core::DepthImage;
use trundle_drivers::camera::native::Selection;
use trundle_drivers::camera::native::freenect::{
    FreenectApi, FreenectCamera, FreenectSettings, list_devices,
};
use trundle_drivers::camera::pixels::depth_from_raw;
use trundle_drivers::camera::{CameraError, DepthCamera, PixelFormat};

const TIMEOUT: Duration = Duration::from_secs(10);
const FRAMES: u32 = 4;
/// Ticks between frames: 60 MHz / 30 Hz.
const PERIOD_TICKS: u32 = 2_000_000;
/// Ticks of the first frame: the counter restarts after the second frame.
const FIRST_TICKS: u32 = u32::MAX - 3_000_000;

fn fakenect() -> Option<PathBuf> {
    debian("fakenect/libfreenect.so.0.5")
}

/// Writes a folder as fakenect-record does: an index, and an image with one header line a file.
fn write_folder(folder: &Path) {
    let mut index = String::new();
    for n in 0..FRAMES {
        let ticks = FIRST_TICKS.wrapping_add(n * PERIOD_TICKS);
        let time = 100.0 + f64::from(n) * 0.01;
        let color = format!("r-{time:.6}-{ticks}.ppm");
        let mut bytes = b"P6 640 480 255\n".to_vec();
        bytes.extend((0..640 * 480).flat_map(|_| [n as u8 + 1, 20, 30]));
        std::fs::write(folder.join(&color), bytes).unwrap();
        let depth = format!("d-{:.6}-{}.pgm", time + 0.001, ticks.wrapping_add(60_000));
        let mut bytes = b"P5 640 480 65535\n".to_vec();
        bytes.extend((0..640 * 480_u32).flat_map(|pixel| raw_disparity(n, pixel).to_le_bytes()));
        std::fs::write(folder.join(&depth), bytes).unwrap();
        index += &format!("{color}\n{depth}\n");
    }
    std::fs::write(folder.join("INDEX.txt"), index).unwrap();
}

fn raw_disparity(n: u32, pixel: u32) -> u16 {
    if pixel == 0 { 2047 } else { 800 + n as u16 }
}

#[test]
fn a_folder_comes_back_whole() {
    let Some(library) = fakenect() else {
        return skip("freenect::a_folder_comes_back_whole", "the package libfreenect0.5");
    };
    let folder = tempfile::tempdir().unwrap();
    write_folder(folder.path());
    let environment = [("FAKENECT_PATH", folder.path().as_os_str()), ("FAKENECT_LOOP", "0".as_ref())];
    if in_child("freenect::a_folder_comes_back_whole", &environment) {
        play(&library);
    }
}

fn play(library: &Path) {
    let api = FreenectApi::load(Some(library)).unwrap();
    assert!(api.is_fake());
    assert_eq!(list_devices(&api).unwrap().len(), 1);
    let mut camera = FreenectCamera::open(&api, &Selection::First, &FreenectSettings::default()).unwrap();
    let info = camera.info().clone();
    assert_eq!((info.color.format, info.depth.format), (PixelFormat::Rgb8, PixelFormat::Disparity11));
    assert!(!info.is_live && info.color_from_depth.is_some());
    let start = Instant::now();
    let mut frames = Vec::new();
    while !camera.has_ended() {
        assert!(start.elapsed() < TIMEOUT, "the folder does not end after {} frames", frames.len());
        frames.extend(camera.next_frame(Duration::from_millis(200)).unwrap());
    }
    assert_eq!(frames.len(), FRAMES as usize);
    let first = frames[0].color.device_stamp;
    for (n, frame) in frames.iter().enumerate() {
        let seconds = n as f64 / 30.0;
        assert!((frame.color.device_stamp - first - seconds).abs() < 1e-6);
        assert!((frame.depth.device_stamp - first - seconds - 0.001).abs() < 1e-6);
        assert_eq!(frame.color.bytes[..3], [n as u8 + 1, 20, 30]);
        assert_eq!(frame.color.bytes.len(), 640 * 480 * 3);
        let mut depth = DepthImage::filled(1, 1, 0.0);
        depth_from_raw(&frame.depth, info.depth_unit_m, &mut depth).unwrap();
        let expected = 1.0 / ((800.0 + n as f64) * -0.003_071_101_6 + 3.330_949_516_1);
        assert_eq!(depth.data()[0], 0.0);
        assert!(depth.data()[1..].iter().all(|metres| (f64::from(*metres) - expected).abs() < 1e-5));
    }
}

#[test]
fn fakenect_without_a_folder_is_an_error_and_not_the_end_of_the_program() {
    const NAME: &str = "freenect::fakenect_without_a_folder_is_an_error_and_not_the_end_of_the_program";
    let Some(library) = fakenect() else { return skip(NAME, "the package libfreenect0.5") };
    assert!(std::env::var_os("FAKENECT_PATH").is_none(), "unset FAKENECT_PATH for this test");
    if in_child(NAME, &[]) {
        let api = FreenectApi::load(Some(&library)).unwrap();
        let error = FreenectCamera::open(&api, &Selection::First, &FreenectSettings::default()).unwrap_err();
        assert!(error.to_string().contains("FAKENECT_PATH"), "{error}");
    }
}

#[test]
fn without_a_kinect_the_error_says_so() {
    let files = debian("libfreenect.so.0.5").zip(crate::support::libusb());
    let Some((library, usb)) = files else {
        return skip("freenect::without_a_kinect", "the package libfreenect0.5 or libusb-1.0-0");
    };
    let api = FreenectApi::load(Some(&crate::support::list(&[usb, library]))).unwrap();
    assert!(!api.is_fake());
    match FreenectCamera::open(&api, &Selection::First, &FreenectSettings::default()).unwrap_err() {
        CameraError::NoDevice { kind } => assert_eq!(kind, "Kinect v1"),
        // A container without /dev/bus/usb: libusb cannot start.
        CameraError::LibraryFailed { function, .. } => assert_eq!(function, "freenect_init"),
        other => panic!("{other}"),
    }
    let file = Selection::File("session".into());
    let refusal = FreenectCamera::open(&api, &file, &FreenectSettings::default()).unwrap_err().to_string();
    assert!(refusal.contains("FAKENECT_PATH"), "{refusal}");
}
