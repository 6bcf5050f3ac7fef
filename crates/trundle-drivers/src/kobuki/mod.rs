//! The Kobuki base: its serial protocol, driver and emulator.
