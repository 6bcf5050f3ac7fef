//! The target `laser_log` under libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trundle_fuzz::targets::laser_log(bytes));
