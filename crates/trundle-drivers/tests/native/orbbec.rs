//! OrbbecSDK without a camera: loading, version, device list, errors.

use crate::support::{find, folder, skip};
use std::ops::RangeInclusive;
use std::path::PathBuf;
use trundle_drivers::camera::CameraError;
use trundle_drivers::camera::native::Selection;
use trundle_drivers::camera::native::orbbec::{
    LIBRARY, OrbbecApi, OrbbecCamera, OrbbecSettings, list_devices,
};

/// Minor versions of OrbbecSDK 2 that these tests have run with: that of the wheel in `bench/drivers/get-native-libraries.sh`.
const TESTED_MINORS: RangeInclusive<u32> = 9..=9;

fn library() -> Option<PathBuf> {
    find(&folder().join("python/pyorbbecsdk"), "libOrbbecSDK.so.2", "")
}

#[test]
fn without_a_camera_the_list_is_empty_opening_says_so_and_no_log_is_written() {
    let Some(library) = library() else { return skip("orbbec::without_a_camera", "the wheel pyorbbecsdk2") };
    let api = OrbbecApi::load(Some(&library)).unwrap();
    let version = api.version();
    println!("OrbbecSDK {version}: {}", api.file().display());
    assert!(version >= LIBRARY.from && version < LIBRARY.below, "{version}");
    assert!(
        version.major == 2 && TESTED_MINORS.contains(&version.minor),
        "OrbbecSDK {version}, expected 2.{TESTED_MINORS:?}: compare its headers with functions.rs, then widen the range"
    );
    assert!(api.file().display().to_string().contains("libOrbbecSDK"));
    assert_eq!(list_devices(&api).unwrap(), []);
    let open = |selection| OrbbecCamera::open(&api, &selection, &OrbbecSettings::default()).unwrap_err();
    assert!(matches!(open(Selection::First), CameraError::NoDevice { .. }));
    let error = open(Selection::Serial("AB12".into()));
    assert!(matches!(error, CameraError::NoDevice { .. }) && error.to_string().contains("AB12"));
    assert!(matches!(open(Selection::File("x.bag".into())), CameraError::StreamsUnavailable { .. }));
    let log = std::env::current_dir().unwrap().join("Log");
    assert!(!log.exists(), "the library wrote {}", log.display());
}
