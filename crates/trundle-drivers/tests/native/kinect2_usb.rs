//! The Kinect V2 through the real libusb, without a device.

use crate::support::{in_child, libusb, skip};
use std::path::PathBuf;
use trundle_drivers::camera::CameraError;
use trundle_drivers::camera::kinect2::usb::{Kinect2UsbCamera, LIBRARY, UsbApi, list_devices};
use trundle_drivers::camera::native::{LibraryState, NativeKind, Selection, open, report};

const NEEDED: &str = "the package libusb-1.0-0";

#[test]
fn the_version_is_that_of_the_library() {
    let Some(library) = libusb() else {
        return skip("kinect2_usb::the_version_is_that_of_the_library", NEEDED);
    };
    let api = UsbApi::load(Some(&library)).unwrap();
    let version = api.version();
    assert!(version >= LIBRARY.from && version < LIBRARY.below, "{version}");
    assert!(api.file().to_string_lossy().contains("libusb-1.0"), "{}", api.file().display());
    println!("libusb {version}: {}", api.file().display());
}

#[test]
fn without_a_device_the_list_is_empty_and_opening_says_so() {
    let Some(library) = libusb() else {
        return skip("kinect2_usb::without_a_device_the_list_is_empty_and_opening_says_so", NEEDED);
    };
    let api = UsbApi::load(Some(&library)).unwrap();
    // Each call starts and ends a session of the library.
    for _ in 0..20 {
        let devices = match list_devices(&api) {
            // A container may have no USB.
            Err(error @ CameraError::LibraryFailed { .. }) if error.to_string().contains("libusb_init") => {
                return println!("SKIPPED kinect2_usb: this machine has no USB: {error}");
            }
            devices => devices.unwrap(),
        };
        if !devices.is_empty() {
            return println!("SKIPPED: a Kinect V2 is plugged in: {devices:?}");
        }
    }
    let error = Kinect2UsbCamera::open(&api, &Selection::First).unwrap_err();
    assert!(matches!(error, CameraError::NoDevice { .. }), "{error}");
    assert!(error.to_string().contains("Kinect V2"), "{error}");
    let serial = Selection::Serial("012345".into());
    let error = Kinect2UsbCamera::open(&api, &serial).unwrap_err().to_string();
    assert!(error.contains("012345"), "{error}");
    let file = Selection::File("a.dump".into());
    let error = Kinect2UsbCamera::open(&api, &file).unwrap_err().to_string();
    assert!(error.contains("kinect2-dump:FILE"), "{error}");
}

#[test]
fn sessions_begin_and_end_in_threads_of_their_own() {
    let Some(library) = libusb() else {
        return skip("kinect2_usb::sessions_begin_and_end_in_threads_of_their_own", NEEDED);
    };
    let api = UsbApi::load(Some(&library)).unwrap();
    let threads: Vec<_> = (0..4)
        .map(|_| {
            let api = api.clone();
            std::thread::spawn(move || (0..5).for_each(|_| drop(list_devices(&api))))
        })
        .collect();
    threads.into_iter().for_each(|thread| thread.join().unwrap());
}

#[test]
fn a_missing_or_wrong_library_is_named() {
    let error = UsbApi::load(Some(&PathBuf::from("/nowhere/libusb-1.0.so.0"))).unwrap_err().to_string();
    assert!(
        error.contains("/nowhere/libusb-1.0.so.0") && error.contains("apt install libusb-1.0-0"),
        "{error}"
    );
    // The C library is a library without the functions.
    let error = UsbApi::load(Some(&PathBuf::from("libc.so.6"))).unwrap_err().to_string();
    assert!(error.contains("libusb_init"), "{error}");
}

#[test]
fn the_kind_is_reported_and_listed() {
    const NAME: &str = "kinect2_usb::the_kind_is_reported_and_listed";
    let Some(library) = libusb() else { return skip(NAME, NEEDED) };
    if !in_child(NAME, &[("TRUNDLE_LIBUSB_LIB", library.as_os_str())]) {
        return;
    }
    assert!(matches!(report(NativeKind::Kinect2Usb).state, LibraryState::Usable { version: Some(_), .. }));
    assert_eq!(
        (NativeKind::Kinect2Usb.to_string().as_str(), NativeKind::Kinect2Usb.cameras()),
        ("kinect2", "Kinect V2")
    );
    if let Err(error) = open(NativeKind::Kinect2Usb, &Selection::First) {
        println!("{error}");
    }
}
