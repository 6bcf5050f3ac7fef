//! The target `image_list` under libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trundle_fuzz::targets::image_list(bytes));
