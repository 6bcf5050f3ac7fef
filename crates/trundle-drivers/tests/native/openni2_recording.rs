//! OpenNI2 opens a recording under any file name: it must not count as a camera.

use crate::openni2::library;
use crate::support::{in_child, skip};
use libloading::{Library, Symbol};
use std::ffi::{CString, c_char, c_int, c_void};
use std::path::Path;
use std::time::Duration;
use trundle_drivers::camera::CameraError;
use trundle_drivers::camera::native::Selection;
use trundle_drivers::camera::native::openni2::{OpenNiApi, OpenNiCamera, OpenNiSettings};

const SENSOR_COLOR: c_int = 2;
const SENSOR_DEPTH: c_int = 3;
/// Duration of the recording: some frames of 30 Hz.
const RECORDED: Duration = Duration::from_millis(200);

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

#[test]
fn a_recording_under_any_name_is_refused() {
    const NAME: &str = "openni2_recording::a_recording_under_any_name_is_refused";
    let Some(path) = library() else { return skip(NAME, "the package libopenni2-0") };
    if !in_child(NAME, &[]) {
        return;
    }
    let api = OpenNiApi::load(Some(&path)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("serial-number");
    // SAFETY: the library is loaded and initialised.
    unsafe { record(&Library::new(api.file()).unwrap(), &file) };
    assert!(file.metadata().unwrap().len() > 100_000, "the recorder wrote no images");
    let name = file.to_str().unwrap();
    for selection in [Selection::Serial(name.into()), Selection::File(file.clone())] {
        let error = OpenNiCamera::open(&api, &selection, &OpenNiSettings::default()).unwrap_err();
        assert!(matches!(error, CameraError::StreamsUnavailable { .. }), "{error}");
        assert!(error.to_string().contains(name), "{error}");
    }
}
