//! The target `kinect2_usb` under libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trundle_fuzz::targets::kinect2_usb(bytes));
