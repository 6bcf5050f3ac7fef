//! One binary of tests on simulated drives.

#![allow(clippy::unwrap_used, reason = "tests")]

mod consistency;
mod localizer;
mod wheels;
