//! Depth cameras behind one trait.
//!
//! | module | content |
//! |---|---|
//! | [`device`] | the trait [`DepthCamera`] |
//! | [`gyro`] | samples of a camera's gyro |
//! | [`info`] | a camera's own description: streams, intrinsics, delay |
//! | [`frame`] | colour and depth as delivered |
//! | [`pixels`] | pixel formats to [`trundle_core::ColorImage`] and [`trundle_core::DepthImage`] |
//! | [`native`] | cameras through the libraries of their makers |
//! | [`registration`] | depth moved into the colour camera |
//! | [`frame_monitor`] | faults found in the frames themselves |
//! | [`pipe`] | frames from a pipe, a file or a growing folder |
//! | [`kinect2`] | depth of the Kinect V2 from its raw packets, read from a file or by USB |
//! | [`camera_thread`] | a camera with its own threads, reopened after faults |

pub mod camera_thread;
pub mod device;
pub mod error;
pub mod frame;
pub mod frame_monitor;
pub mod gyro;
pub mod info;
pub mod kinect2;
pub mod native;
pub mod pipe;
pub mod pixel_format;
pub mod pixels;
pub mod registration;

pub use camera_thread::{CameraCounters, CameraThread, CameraThreadConfig, CameraThreadParts};
pub use device::DepthCamera;
pub use error::CameraError;
pub use frame::{CameraFrame, RawImage};
pub use frame_monitor::{CameraFault, FrameMonitor};
pub use gyro::GyroSample;
pub use info::{CameraInfo, StreamInfo, UsbSpeed};
pub use pixel_format::PixelFormat;
