//! Drivers of bases and depth cameras: bodies behind the traits of [`trundle_core`].
//!
//! | module | content |
//! |---|---|
//! | [`kobuki`] | protocol, driver and emulator of the Kobuki base |
//! | [`camera`] | depth cameras: one trait, pixel formats, registration of depth to colour |
//! | [`clock`] | device clocks mapped to one clock, events put in order |
//!
//! [`BaseSpec`] and [`CameraSpec`] are a user's names of a base and a camera.
//!
//! ```
//! use trundle_drivers::{BaseSpec, CameraSpec};
//! let base: BaseSpec = "kobuki:/dev/ttyUSB0".parse()?;
//! assert_eq!(base.to_string(), "kobuki:/dev/ttyUSB0");
//! let camera: CameraSpec = "stream:/tmp/camera".parse()?;
//! assert_eq!(camera.to_string(), "stream:/tmp/camera");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod base_spec;
pub mod camera;
mod camera_spec;
pub mod clock;
pub mod kobuki;
mod kobuki_finder;
mod serial_devices;

pub use base_spec::{BaseSpec, KOBUKI_UDEV_RULE};
pub use camera_spec::{CameraSpec, SERVE_COMMAND};
pub use kobuki_finder::KOBUKI_UDEV_PORT;
pub use serial_devices::{PortAccess, SerialDevice, serial_devices};
