//! One binary of tests on simulated drives.

#![allow(clippy::unwrap_used, reason = "tests")]

mod consistency;
mod drive;
mod localizer;
mod smoother;
mod wheels;
