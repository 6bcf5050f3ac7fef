//! The target `dbow2` under libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trundle_fuzz::targets::dbow2(bytes));
