//! The driver of the Kobuki against the emulated base, over a real pseudo terminal.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod device;
mod driving;
mod faults;
mod rig;
mod start;
