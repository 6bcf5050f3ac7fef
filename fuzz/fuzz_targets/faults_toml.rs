//! The target `faults_toml` under libFuzzer.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| trundle_fuzz::targets::faults_toml(bytes));
