//! OrbbecSDK without a camera: loading, version, device list, errors.

use crate::support::{find, folder, skip};
use std::path::PathBuf;
use std::sync::Arc;
use trundle_drivers::camera::CameraError;
use trundle_drivers::camera::native::Selection;
use trundle_drivers::camera::native::orbbec::{OrbbecApi, OrbbecCamera, OrbbecSettings, list_devices};

fn library() -> Option<PathBuf> {
    find(&folder().join("python/pyorbbecsdk"), "libOrbbecSDK.so.2", "")
}

fn api(name: &str) -> Option<Arc<OrbbecApi>> {
    let Some(library) = library() else {
        skip(name, "the wheel pyorbbecsdk2");
        return None;
    };
    Some(OrbbecApi::load(Some(&library)).unwrap())
}

#[test]
fn without_a_camera_the_list_is_empty_and_opening_says_so() {
    let Some(api) = api("orbbec::without_a_camera") else { return };
    assert_eq!(api.version().major, 2);
    assert!(api.file().display().to_string().contains("libOrbbecSDK"));
    assert_eq!(list_devices(&api).unwrap(), []);
    let open = |selection| OrbbecCamera::open(&api, &selection, &OrbbecSettings::default()).unwrap_err();
    assert!(matches!(open(Selection::First), CameraError::NoDevice { .. }));
    let error = open(Selection::Serial("AB12".into()));
    assert!(matches!(error, CameraError::NoDevice { .. }) && error.to_string().contains("AB12"));
    assert!(matches!(open(Selection::File("x.bag".into())), CameraError::StreamsUnavailable { .. }));
}

#[test]
fn the_library_leaves_no_log_behind() {
    let Some(api) = api("orbbec::the_library_leaves_no_log") else { return };
    assert_eq!(list_devices(&api).unwrap(), []);
    assert!(!std::env::current_dir().unwrap().join("Log").exists());
}
