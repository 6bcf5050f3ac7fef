//! Tests of the cameras with the real libraries of their manufacturers.
//!
//! `bench/drivers/get-native-libraries.sh` downloads the libraries. A test without its library prints its name and is skipped; it fails
//! instead if the environment variable `TRUNDLE_REQUIRE_NATIVE_LIBRARIES` is set.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests")]

mod all_kinds;
mod freenect;
#[cfg(feature = "kinect2-usb")]
mod kinect2_usb;
mod library;
mod openni2;
mod openni2_recording;
mod orbbec;
mod realsense;
mod support;
