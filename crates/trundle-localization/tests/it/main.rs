//! One binary of tests on simulated drives.

mod consistency;
mod localizer;
mod wheels;
