//! The RealSense camera: librealsense records a software device, and the camera plays the file.

use crate::support::{find, folder, libusb, list, skip};
use nalgebra::{Matrix3, UnitQuaternion};
use std::ffi::{c_float, c_int};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use trundle_core::{PinholeCamera, SensorEvent, Stamp, Vector2, Vector3};
use trundle_drivers::camera::camera_thread::recorded_stamps;
use trundle_drivers::camera::native::library::NativeLibrary;
use trundle_drivers::camera::native::realsense::{
    LIBRARY, RealSenseApi, RealSenseCamera, RealSenseSettings, list_devices,
};
use trundle_drivers::camera::native::{Selection, realsense};
use trundle_drivers::camera::{
    CameraError, CameraFrame, CameraThread, CameraThreadConfig, CameraThreadParts, DepthCamera, PixelFormat,
    UsbSpeed,
};

const TIMEOUT: Duration = Duration::from_secs(10);
const FRAMES: usize = 5;
/// Samples of the gyro: four an image.
const SAMPLES: usize = 20;

/// The files of librealsense: libusb, libpython, the wheel.
fn library() -> Option<PathBuf> {
    let module = find(&folder().join("python/pyrealsense2"), "pyrealsense2.cpython", ".so")?;
    let name = module.file_name()?.to_str()?;
    let minor = name.split(".cpython-3").nth(1)?.split('-').next()?;
    let files = list(&[libusb()?, format!("libpython3.{minor}.so.1.0").into(), module.clone()]);
    NativeLibrary::load(LIBRARY, Some(&files)).ok()?;
    Some(files)
}

/// Records into `file` by the wheel in the folder `wheel`.
fn record(file: &Path, wheel: &Path) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/native/realsense_recording.py");
    let usb = libusb().unwrap();
    let output = Command::new("python3")
        .arg(script)
        .arg(wheel)
        .arg(file)
        .env("LD_LIBRARY_PATH", usb.parent().unwrap())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A recording in a folder of its own.
fn recorded() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("software.db3");
    record(&file, &self::folder().join("python"));
    (folder, file)
}

fn all_frames(camera: &mut RealSenseCamera) -> Vec<CameraFrame> {
    let start = std::time::Instant::now();
    let mut frames = Vec::new();
    while !camera.has_ended() {
        assert!(start.elapsed() < TIMEOUT, "the recording does not end after {} frames", frames.len());
        frames.extend(camera.next_frame(Duration::from_millis(100)).unwrap());
    }
    frames
}

#[test]
fn a_recording_comes_back_whole() {
    let Some(library) = library() else {
        return skip("realsense::a_recording_comes_back_whole", "the wheel pyrealsense2 or its libpython");
    };
    let (_folder, file) = recorded();
    check_recording(&library, file);
}

#[test]
fn a_bag_of_an_older_librealsense_comes_back_whole() {
    let wheel = folder().join("python-bag");
    let (Some(library), true) = (library(), wheel.join("pyrealsense2").exists()) else {
        return skip("realsense::a_bag_of_an_older_librealsense", "a wheel pyrealsense2 or its libpython");
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("software.bag");
    record(&file, &wheel);
    assert!(std::fs::read(&file).unwrap().starts_with(b"#ROSBAG V2.0"));
    check_recording(&library, file);
}

/// Every frame of the recording is played, with the camera's description.
fn check_recording(library: &Path, file: PathBuf) {
    let api = RealSenseApi::load(Some(library)).unwrap();
    let settings = RealSenseSettings::default();
    let mut camera = RealSenseCamera::open(&api, &Selection::File(file), &settings).unwrap();
    check_info(&camera, library);
    let frames = all_frames(&mut camera);
    let stamps: Vec<_> = frames.iter().map(|frame| frame.depth.device_stamp.to_string()).collect();
    assert_eq!(frames.len(), FRAMES, "{stamps:?}");
    frames.iter().enumerate().for_each(|(n, frame)| check_frame(n, frame));
    assert!(camera.take_gyro().is_empty(), "no gyro was requested");
}

#[test]
fn a_recording_with_the_gyro_has_right_samples_in_order() {
    let Some(library) = library() else {
        return skip("realsense::a_recording_with_the_gyro", "the wheel pyrealsense2 or its libpython");
    };
    let (_folder, file) = recorded();
    let api = RealSenseApi::load(Some(&library)).unwrap();
    let mut settings = RealSenseSettings::default();
    settings.gyro = true;
    let mut camera = RealSenseCamera::open(&api, &Selection::File(file), &settings).unwrap();
    all_frames(&mut camera).iter().for_each(|frame| check_frame(number_of(frame), frame));
    check_gyro(&mut camera);
}

/// Number of a frame of the recording by its stamp.
fn number_of(frame: &CameraFrame) -> usize {
    ((frame.depth.device_stamp.nanos - 1_000_000_000) / 33_250_000) as usize
}

fn check_info(camera: &RealSenseCamera, library: &Path) {
    let info = camera.info();
    assert_eq!((info.name.as_str(), info.serial.as_str()), ("Intel RealSense D435I", "012345"));
    assert_eq!((info.firmware.as_str(), info.usb), ("5.16.0.1", Some(UsbSpeed::Super)));
    assert!((info.depth_unit_m - 0.00025).abs() < 1e-9 && !info.is_live);
    assert_eq!((info.color.format, info.depth.format), (PixelFormat::Rgb8, PixelFormat::Depth16));
    let depth = info.depth.camera;
    assert_eq!((depth.width(), depth.height(), depth.fx(), depth.fy()), (64, 48, 50.0, 51.0));
    assert_eq!((depth.cx(), depth.cy(), info.depth.rate_hz), (31.5, 24.25, 30.0));
    let moved = info.color_from_depth.unwrap().transform(Vector3::new(1.0, 0.0, 2.0));
    assert!((moved - Vector3::new(0.015, 1.001, 2.002)).norm() < 1e-6, "{moved}");
    check_lens(&info.color.camera, library);
}

/// The fitted lens undistorts as the library does.
fn check_lens(camera: &PinholeCamera, library: &Path) {
    type Deproject =
        unsafe extern "C" fn(*mut c_float, *const realsense::functions::Intrinsics, *const c_float, c_float);
    const INVERSE_BROWN_CONRADY: c_int = 2;
    let library = NativeLibrary::load(LIBRARY, Some(library)).unwrap();
    // SAFETY: the type is the documented one.
    let deproject: Deproject = unsafe { library.function("rs2_deproject_pixel_to_point") }.unwrap();
    let raw = realsense::functions::Intrinsics {
        width: 80,
        height: 60,
        ppx: 39.5,
        ppy: 30.25,
        fx: 76.0,
        fy: 77.0,
        model: INVERSE_BROWN_CONRADY,
        coeffs: [-0.054, 0.066, -0.0007, 0.0003, -0.021],
    };
    for pixel in [[0.0, 0.0], [79.0, 59.0], [10.0, 50.0], [39.5, 30.25]] {
        let mut point = [0.0; 3];
        // SAFETY: all arrays are valid and have the documented lengths.
        unsafe { deproject(point.as_mut_ptr(), &raw, pixel.as_ptr(), 2.0) };
        let expected = camera.project(Vector3::from(point.map(f64::from))).unwrap();
        let found = camera.undistort(Vector2::new(f64::from(pixel[0]), f64::from(pixel[1])));
        assert!((found - expected).norm() < 0.05, "{pixel:?}: {found} {expected}");
    }
    assert!(camera.distortion().k1 < -0.01, "the lens is fitted");
}

fn check_frame(n: usize, frame: &CameraFrame) {
    let nanos = 1_000_000_000 + 33_250_000 * n as i64;
    assert_eq!(frame.depth.device_stamp.nanos, nanos);
    assert_eq!(frame.color.device_stamp.nanos, nanos + 500_000);
    let depth: Vec<u16> =
        frame.depth.bytes.chunks_exact(2).map(|two| u16::from_le_bytes([two[0], two[1]])).collect();
    assert_eq!((depth.len(), depth[0]), (64 * 48, 7));
    assert!(depth[1..].iter().all(|value| *value == 100 * n as u16 + 1));
    assert_eq!((frame.color.width, frame.color.height, frame.color.bytes.len()), (80, 60, 80 * 60 * 3));
    assert_eq!(frame.color.bytes[..3], [9, 8, 7]);
    assert!(frame.color.bytes[3..].iter().all(|value| *value == n as u8 + 1));
}

fn check_gyro(camera: &mut RealSenseCamera) {
    let samples = camera.take_gyro();
    let numbers = sample_numbers(samples.iter().map(|sample| sample.device_stamp.nanos));
    for (m, sample) in numbers.into_iter().zip(&samples) {
        assert!((sample.rate - Vector3::new(0.1, 0.2, 0.3 + m as f64)).norm() < 1e-5, "{sample:?}");
    }
    assert!(camera.take_gyro().is_empty());
}

/// Numbers of the samples of the gyro by their stamps [ns], which increase. With the gyro, librealsense plays at the pace of the stamps, and
/// drops what a busy computer does not take in time.
fn sample_numbers(stamps: impl Iterator<Item = i64>) -> Vec<usize> {
    let numbers: Vec<usize> = stamps.map(|nanos| ((nanos - 999_000_000) / 8_000_000) as usize).collect();
    let is_in_order = numbers.windows(2).all(|pair| pair[0] < pair[1]);
    assert!(is_in_order && numbers.last().is_some_and(|last| *last < SAMPLES), "{numbers:?}");
    numbers
}

#[test]
fn the_gyro_of_a_camera_comes_as_turns_of_the_base() {
    let Some(library) = library() else {
        return skip("realsense::the_gyro_of_a_camera", "the wheel pyrealsense2 or its libpython");
    };
    let (_folder, file) = recorded();
    let open = move || -> Result<Box<dyn DepthCamera>, CameraError> {
        let mut settings = RealSenseSettings::default();
        settings.gyro = true;
        let api = RealSenseApi::load(Some(&library))?;
        Ok(Box::new(RealSenseCamera::open(&api, &Selection::File(file.clone()), &settings)?))
    };
    // A level camera that looks ahead: x to the right, y down, z ahead.
    let axes = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    let base_from_camera = UnitQuaternion::from_matrix(&axes);
    let mut config = CameraThreadConfig::default();
    config.gyro = Some(base_from_camera);
    let events = Arc::<Mutex<Vec<SensorEvent>>>::default();
    let kept = Arc::clone(&events);
    let parts = CameraThreadParts {
        factory: Box::new(open),
        sink: Box::new(move |event| kept.lock().unwrap().push(event)),
        clock: Arc::new(Stamp::default),
        stamps: Box::new(recorded_stamps),
    };
    let camera = CameraThread::start(parts, config).unwrap();
    let start = std::time::Instant::now();
    while !camera.has_ended() {
        assert!(start.elapsed() < TIMEOUT, "the recording does not end");
        std::thread::sleep(Duration::from_millis(10));
    }
    let events = std::mem::take(&mut *events.lock().unwrap());
    let images = events.iter().filter(|event| matches!(event, SensorEvent::Rgbd(_))).count();
    let turns: Vec<_> = events
        .iter()
        .filter_map(|event| if let SensorEvent::Gyro(rate) = event { Some(*rate) } else { None })
        .collect();
    assert!((1..=FRAMES).contains(&images), "{images} images");
    sample_numbers(turns.iter().map(|turn| turn.stamp.nanos));
    // The recorded extrinsics turn the depth camera's x onto the colour camera's y, which points down.
    assert!(turns.iter().all(|turn| (turn.omega + 0.1).abs() < 1e-6), "{turns:?}");
}

#[test]
fn a_recording_may_be_left_in_the_middle_and_opened_again() {
    let Some(library) = library() else {
        return skip("realsense::a_recording_may_be_left", "the wheel pyrealsense2 or its libpython");
    };
    let (_folder, file) = recorded();
    let api = RealSenseApi::load(Some(&library)).unwrap();
    for _ in 0..3 {
        let selection = Selection::File(file.clone());
        let mut camera = RealSenseCamera::open(&api, &selection, &RealSenseSettings::default()).unwrap();
        check_frame(0, &camera.next_frame(TIMEOUT).unwrap().unwrap());
    }
}

#[test]
fn without_a_camera_or_a_recording_the_error_says_so() {
    let Some(library) = library() else {
        return skip("realsense::without_a_camera", "the wheel pyrealsense2 or its libpython");
    };
    let api = RealSenseApi::load(Some(&library)).unwrap();
    assert_eq!(api.version().unwrap().major, 2);
    assert!(api.file().display().to_string().contains("pyrealsense2"));
    assert_eq!(list_devices(&api).unwrap(), []);
    let open = |selection: Selection| {
        RealSenseCamera::open(&api, &selection, &RealSenseSettings::default()).unwrap_err()
    };
    assert!(matches!(open(Selection::First), CameraError::NoDevice { .. }));
    let by_serial = open(Selection::Serial("77".into()));
    assert!(matches!(by_serial, CameraError::NoDevice { .. }) && by_serial.to_string().contains("77"));
    assert!(matches!(open(Selection::File("/nowhere.db3".into())), CameraError::Io { .. }));
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.db3");
    std::fs::write(&broken, b"no recording").unwrap();
    let error = open(Selection::File(broken));
    assert!(matches!(error, CameraError::LibraryFailed { .. }), "{error}");
}
