//! Drivers of bases and depth cameras: bodies behind the traits of [`trundle_core`].
//!
//! | module | content |
//! |---|---|
//! | [`kobuki`] | protocol, driver and emulator of the Kobuki base |
//! | [`camera`] | depth cameras: one trait, pixel formats, registration of depth to colour |
//! | [`clock`] | device clocks mapped to one clock, events put in order |

pub mod camera;
pub mod clock;
pub mod kobuki;
