//! Loading and its errors.

use std::path::Path;
use trundle_drivers::camera::CameraError;
use trundle_drivers::camera::native::library::NativeLibrary;
use trundle_drivers::camera::native::library::spec::{LibrarySpec, LibraryVersion};
use trundle_drivers::camera::native::realsense::{LIBRARY, RealSenseApi};

fn absent() -> LibrarySpec {
    LibrarySpec { name: "libabsent", variable: "TRUNDLE_ABSENT_LIB", sonames: &["libabsent.so.1"], ..LIBRARY }
}

#[test]
fn an_absent_library_is_named_with_the_command_that_gets_it() {
    let error = NativeLibrary::load(absent(), None).unwrap_err();
    assert!(matches!(error, CameraError::LibraryMissing { .. }), "{error}");
    assert!(error.to_string().contains("pip install"), "{error}");
}

#[test]
fn a_wrong_file_in_the_settings_is_an_error_with_its_path() {
    let error = NativeLibrary::load(absent(), Some(Path::new("/nowhere/libx.so"))).unwrap_err().to_string();
    assert!(error.contains("/nowhere/libx.so") && error.contains("the settings"), "{error}");
}

#[test]
fn a_library_without_the_functions_is_refused_with_their_names() {
    let error = RealSenseApi::load(Some(Path::new("libm.so.6"))).unwrap_err();
    assert!(matches!(error, CameraError::VersionUnsuitable { .. }), "{error}");
    assert!(error.to_string().contains("rs2_get_api_version"), "{error}");
}

#[test]
fn a_version_outside_the_range_is_refused() {
    let refusal = LIBRARY.check(LibraryVersion::from_decimal(30_102)).unwrap_err().to_string();
    assert!(refusal.contains("3.1.2") && refusal.contains("2.50.0"), "{refusal}");
    assert!(LIBRARY.check(LibraryVersion::from_decimal(25_901)).is_ok());
}
