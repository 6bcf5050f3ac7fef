//! Recordings of OpenNI2, which opens them under any file name: they must not count as cameras.

use crate::openni2::{check, library, settings};
use crate::support::{in_child, skip};
use libloading::{Library, Symbol};
use std::ffi::{CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trundle_drivers::camera::native::Selection;
use trundle_drivers::camera::native::openni2::{OpenNiApi, OpenNiCamera};
use trundle_drivers::camera::{CameraError, CameraFrame, DepthCamera};

const SENSOR_COLOR: c_int = 2;
const SENSOR_DEPTH: c_int = 3;
/// Duration of the recording: some frames of 30 Hz.
const RECORDED: Duration = Duration::from_millis(500);

type Object = *mut c_void;

/// Records the images of the dummy device by the library's own recorder.
///
/// # Safety
/// The signatures are those of `OniCAPI.h`, version 2.2.
unsafe fn record(library: &Library, file: &Path) {
    type Open = unsafe extern "C" fn(*const c_char, *mut Object) -> c_int;
    type CreateStream = unsafe extern "C" fn(Object, c_int, *mut Object) -> c_int;
    type Attach = unsafe extern "C" fn(Object, Object, c_int) -> c_int;
    type OfObject = unsafe extern "C" fn(Object) -> c_int;
    let (device_name, file) = (CString::new("Dummy").unwrap(), CString::new(file.to_str().unwrap()).unwrap());
    let (mut device, mut recorder) = (std::ptr::null_mut(), std::ptr::null_mut());
    // SAFETY: each object is made by the library before it is used.
    unsafe {
        let open: Symbol<'_, Open> = library.get(b"oniDeviceOpen").unwrap();
        let create_stream: Symbol<'_, CreateStream> = library.get(b"oniDeviceCreateStream").unwrap();
        let create_recorder: Symbol<'_, Open> = library.get(b"oniCreateRecorder").unwrap();
        let attach: Symbol<'_, Attach> = library.get(b"oniRecorderAttachStream").unwrap();
        let of_object = |name: &[u8]| -> Symbol<'_, OfObject> { library.get(name).unwrap() };
        assert_eq!(open(device_name.as_ptr(), &mut device), 0);
        assert_eq!(create_recorder(file.as_ptr(), &mut recorder), 0);
        let streams = [SENSOR_COLOR, SENSOR_DEPTH].map(|sensor| {
            let mut stream = std::ptr::null_mut();
            assert_eq!(create_stream(device, sensor, &mut stream), 0);
            assert_eq!(attach(recorder, stream, 0), 0);
            stream
        });
        assert_eq!(of_object(b"oniRecorderStart")(recorder), 0);
        streams.iter().for_each(|stream| assert_eq!(of_object(b"oniStreamStart")(*stream), 0));
        std::thread::sleep(RECORDED);
        of_object(b"oniRecorderStop")(recorder);
        let destroy: Symbol<'_, unsafe extern "C" fn(*mut Object) -> c_int> =
            library.get(b"oniRecorderDestroy").unwrap();
        destroy(&mut recorder);
    }
}

/// Record of a property of whole numbers in the head of a recording: its type, its length of name, its name, its length of value.
const WHOLE_NUMBER_TYPE: u8 = 3;
const UNUSED_PROPERTY: &[u8] = b"\x0f\0\0\0xnIsGenerating\0\x08\0\0\0";
/// Record of the cropping that a real camera's recording has, of the same length: not cropped.
const GENERAL_TYPE: u8 = 6;
const CROPPING: &[u8] = b"\x0b\0\0\0xnCropping\0\x0c\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
/// Bytes from the type in a record's head to its content.
const TYPE_TO_CONTENT_BYTES: usize = 24;
/// Beginnings of the records of an image of colour (1) and of depth (2).
const IMAGE_RECORDS: [&[u8]; 2] = [b"NIR\0\x0a\0\0\0\x01\0\0\0", b"NIR\0\x0a\0\0\0\x02\0\0\0"];

fn places<'a>(bytes: &'a [u8], part: &'a [u8]) -> impl Iterator<Item = usize> + 'a {
    bytes.windows(part.len()).enumerate().filter(move |(_, window)| *window == part).map(|(place, _)| place)
}

/// Gives both streams of a recording the cropping of a real camera's, in place of a property that the library does not use.
fn add_cropping(file: &Path) {
    let mut bytes = std::fs::read(file).unwrap();
    let found: Vec<usize> = places(&bytes, UNUSED_PROPERTY).collect();
    assert_eq!(found.len(), 2, "one of each stream");
    for place in found {
        let kind = &mut bytes[place - TYPE_TO_CONTENT_BYTES];
        assert_eq!(std::mem::replace(kind, GENERAL_TYPE), WHOLE_NUMBER_TYPE);
        bytes[place..place + CROPPING.len()].copy_from_slice(CROPPING);
    }
    std::fs::write(file, bytes).unwrap();
}

/// A recording of the dummy device under a name that does not show its kind.
fn recorded(api: &OpenNiApi) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("serial-number");
    // SAFETY: the library is loaded and initialised.
    unsafe { record(&Library::new(api.file()).unwrap(), &file) };
    assert!(file.metadata().unwrap().len() > 100_000, "the recorder wrote no images");
    (folder, file)
}

#[test]
fn a_recording_of_a_camera_comes_back_whole() {
    const NAME: &str = "openni2_recording::a_recording_of_a_camera_comes_back_whole";
    let Some(path) = library() else { return skip(NAME, "the package libopenni2-0") };
    if !in_child(NAME, &[]) {
        return;
    }
    let api = OpenNiApi::load(Some(&path)).unwrap();
    let (_folder, file) = recorded(&api);
    add_cropping(&file);
    let bytes = std::fs::read(&file).unwrap();
    let expected = IMAGE_RECORDS.map(|record| places(&bytes, record).count()).into_iter().min().unwrap();
    assert!(expected >= 2, "{expected} images");
    // A program plays each file once.
    let copy = file.with_extension("oni");
    std::fs::copy(&file, &copy).unwrap();
    for selection in [Selection::Serial(file.to_str().unwrap().into()), Selection::File(copy)] {
        let mut camera = OpenNiCamera::open(&api, &selection, &settings(path.clone())).unwrap();
        assert!(!camera.info().is_live, "a base must not drive by it");
        let (start, mut frames) = (Instant::now(), Vec::new());
        while !camera.has_ended() {
            assert!(start.elapsed() < Duration::from_secs(10), "no end after {} frames", frames.len());
            frames.extend(camera.next_frame(Duration::from_millis(100)).unwrap());
        }
        frames.iter().for_each(check);
        assert_eq!(frames.len(), expected);
        let step = |two: &[CameraFrame]| two[1].depth.device_stamp.nanos - two[0].depth.device_stamp.nanos;
        assert!(frames.windows(2).all(|two| step(two) == 33_000_000), "a frame is missing");
    }
}

#[test]
fn a_recording_without_cropping_is_refused_under_any_name() {
    const NAME: &str = "openni2_recording::a_recording_without_cropping_is_refused_under_any_name";
    let Some(path) = library() else { return skip(NAME, "the package libopenni2-0") };
    if !in_child(NAME, &[]) {
        return;
    }
    let api = OpenNiApi::load(Some(&path)).unwrap();
    let (_folder, file) = recorded(&api);
    let name = file.to_str().unwrap();
    for selection in [Selection::Serial(name.into()), Selection::File(file.clone())] {
        let error = OpenNiCamera::open(&api, &selection, &settings(path.clone())).unwrap_err();
        assert!(matches!(error, CameraError::StreamsUnavailable { .. }), "{error}");
        assert!(error.to_string().contains(name) && error.to_string().contains("cropping"), "{error}");
    }
}
