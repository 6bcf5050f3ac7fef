//! OpenNI2: its dummy device, in a separate process.

use crate::support::{debian, in_child, libusb, list, skip};
use std::path::PathBuf;
use std::time::Duration;
use trundle_core::PinholeCamera;
use trundle_drivers::camera::native::openni2::{
    OpenNiApi, OpenNiCamera, OpenNiSettings, list_devices, serve_openni,
};
use trundle_drivers::camera::native::{RgbdCalibration, Selection};
use trundle_drivers::camera::{CameraError, CameraFrame, DepthCamera, PixelFormat};

const TIMEOUT: Duration = Duration::from_secs(5);
const FRAMES: usize = 3;

/// The library; libusb and libjpeg are loaded before it.
pub fn library() -> Option<PathBuf> {
    Some(list(&[libusb()?, debian("libjpeg.so.62")?, debian("libOpenNI2.so.0")?]))
}

/// Settings with the fields of view that the dummy device does not report.
pub fn settings(library: PathBuf) -> OpenNiSettings {
    let camera = PinholeCamera::from_field_of_view((320, 240), (1.0, 0.8)).unwrap();
    let calibration = RgbdCalibration { color: camera, depth: camera, color_from_depth: None };
    let mut settings = OpenNiSettings::default();
    settings.calibration = Some(calibration);
    settings.library = Some(library);
    settings
}

/// Checks a pair of the dummy device.
pub fn check(frame: &CameraFrame) {
    assert_eq!((frame.color.format, frame.color.bytes.len()), (PixelFormat::Rgb8, 320 * 240 * 3));
    assert_eq!((frame.depth.format, frame.depth.bytes.len()), (PixelFormat::Depth16, 320 * 240 * 2));
    assert!((frame.color.device_stamp - frame.depth.device_stamp).abs() <= 0.017);
    assert_eq!(frame.depth.bytes[..2], 2000_u16.to_le_bytes());
}

#[test]
fn the_dummy_device_delivers_pairs() {
    const NAME: &str = "openni2::the_dummy_device_delivers_pairs";
    let Some(library) = library() else { return skip(NAME, "the package libopenni2-0") };
    if !in_child(NAME, &[]) {
        return;
    }
    let api = OpenNiApi::load(Some(&library)).unwrap();
    assert_eq!(api.version().major, 2);
    let selection = Selection::Serial("Dummy".into());
    let uncalibrated = OpenNiCamera::open(&api, &selection, &OpenNiSettings::default()).unwrap_err();
    assert!(matches!(uncalibrated, CameraError::IntrinsicsUnusable { .. }), "{uncalibrated}");
    let mut camera = OpenNiCamera::open(&api, &selection, &settings(library)).unwrap();
    let info = camera.info();
    assert_eq!((info.serial.as_str(), info.depth_unit_m, info.depth.rate_hz), ("Dummy", 0.001, 30.0));
    let frames: Vec<CameraFrame> =
        (0..FRAMES).map(|_| camera.next_frame(TIMEOUT).unwrap().unwrap()).collect();
    frames.iter().for_each(check);
    assert!(frames.windows(2).all(|two| two[1].color.device_stamp > two[0].color.device_stamp));
}

#[test]
fn frames_are_served_until_the_receiver_fails() {
    const NAME: &str = "openni2::frames_are_served_until_the_receiver_fails";
    let Some(library) = library() else { return skip(NAME, "the package libopenni2-0") };
    if !in_child(NAME, &[]) {
        return;
    }
    let mut count = 0;
    let selection = Selection::Serial("Dummy".into());
    let served = serve_openni(&selection, &settings(library), |info| {
        assert_eq!(info.serial, "Dummy");
        Ok(|frame: CameraFrame| {
            check(&frame);
            count += 1;
            let full = || CameraError::Unplugged { device: "the reader".into() };
            if count == FRAMES { Err(full()) } else { Ok(()) }
        })
    });
    assert!(matches!(served, Err(CameraError::Unplugged { .. })));
    assert_eq!(count, FRAMES);
}

#[test]
fn without_a_camera_the_error_says_so() {
    const NAME: &str = "openni2::without_a_camera_the_error_says_so";
    let Some(library) = library() else { return skip(NAME, "the package libopenni2-0") };
    if !in_child(NAME, &[]) {
        return;
    }
    let api = OpenNiApi::load(Some(&library)).unwrap();
    assert_eq!(list_devices(&api).unwrap(), []);
    let open = |selection| OpenNiCamera::open(&api, &selection, &OpenNiSettings::default()).unwrap_err();
    assert!(matches!(open(Selection::First), CameraError::NoDevice { .. }));
    assert!(matches!(open(Selection::Serial("1d27/0601@1/9".into())), CameraError::NoDevice { .. }));
    assert!(matches!(open(Selection::File("/nowhere.oni".into())), CameraError::Io { .. }));
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.oni");
    std::fs::write(&broken, b"no recording").unwrap();
    let error = open(Selection::File(broken));
    assert!(matches!(error, CameraError::LibraryFailed { .. } | CameraError::NoDevice { .. }), "{error}");
}
