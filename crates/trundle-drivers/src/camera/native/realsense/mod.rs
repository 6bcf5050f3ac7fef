//! RealSense cameras (D415, D435, D435i, D455) through librealsense2.
//!
//! Tested with version 2.59.1 and recordings of a software device. It was not tested with a real camera: start-up, errors and speeds follow
//! the documentation.
//!
//! librealsense 2.59 records statistics of its use in a file. It sends that file only after consent in its viewer; this driver gives no
//! consent.
//!
//! | module | content |
//! |---|---|
//! | [`settings`] | size, rate, gyro |
//! | [`camera`] | the camera |
//! | [`intrinsics`] | lens models and poses |
//! | [`functions`] | the functions of the library |
//! | `api`, `handle`, `error` | loading, calls, objects, errors |
//! | `device_list`, `request`, `streams` | connected cameras, requested streams, offered streams |
//! | `running`, `frames`, `pairing`, `motion` | a started pipeline, received frames, pairs, samples of the gyro |

mod api;
pub mod camera;
mod constants;
mod device_list;
mod error;
mod frames;
pub mod functions;
mod handle;
pub mod intrinsics;
mod motion;
mod pairing;
mod request;
mod running;
pub mod settings;
mod streams;

pub use api::LIBRARY;
pub use camera::RealSenseCamera;
pub use device_list::list_devices;
pub use functions::RealSenseApi;
pub use settings::RealSenseSettings;
