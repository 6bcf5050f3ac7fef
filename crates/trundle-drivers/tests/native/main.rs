//! Tests of the cameras through the libraries of their makers, with the real libraries.
//!
//! `bench/drivers/get-native-libraries.sh` gets the libraries. A test whose library is absent prints its name and is skipped; it fails instead
//! where the environment variable `TRUNDLE_REQUIRE_NATIVE_LIBRARIES` is set.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests")]

mod all_kinds;
mod freenect;
#[cfg(feature = "kinect2-usb")]
mod kinect2_usb;
mod library;
mod openni2;
mod orbbec;
mod realsense;
mod support;
