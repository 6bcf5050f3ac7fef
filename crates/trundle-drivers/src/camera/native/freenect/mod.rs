//! The Kinect v1 (Kinect for Xbox 360) through libfreenect 0.5.
//!
//! Tested with fakenect, a library with the same functions that plays a folder. It was not tested with a real Kinect.
//!
//! Depth comes as raw disparity of 11 bits, which [`crate::camera::pixels`] converts to metres. The calibration is assumed unless the settings
//! give one.
//!
//! | module | content |
//! |---|---|
//! | [`camera`] | the camera and its settings |
//! | [`calibration`] | intrinsics and extrinsics |
//! | [`functions`] | the functions of the library |
//! | `session` | connection and open device |
//! | `receiver`, `ticks` | received images, and their clock |

pub mod calibration;
pub mod camera;
pub mod functions;
mod receiver;
mod session;
mod ticks;

pub use calibration::assumed_calibration;
pub use camera::{FreenectCamera, FreenectSettings, list_devices};
pub use functions::{FreenectApi, LIBRARY};
