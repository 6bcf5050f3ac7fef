//! Cameras through the libraries of their manufacturers, which are loaded at run time.
//!
//! | module | content |
//! |---|---|
//! | [`library`] | search, version and functions of a library |
//! | [`realsense`] | RealSense D4xx, librealsense2 |
//! | [`freenect`] | Kinect v1, libfreenect |
//! | [`orbbec`] | Orbbec, OrbbecSDK 2 |
//! | [`openni2`] | Xtion and Astra, OpenNI2 |
//! | [`selection`] | which camera to open |
//! | [`calibration`] | a calibration in the settings |
//! | [`distortion_fit`] | lens models of other makers as [`trundle_core::Distortion`] |
//! | `all_kinds` | reports, lists and cameras of all kinds |
//! | `image_pair` | colour and depth that arrive one by one |

mod all_kinds;
pub mod calibration;
pub mod distortion_fit;
pub mod freenect;
pub(super) mod image_pair;
pub mod library;
pub mod openni2;
pub mod orbbec;
pub mod realsense;
pub mod selection;

pub use all_kinds::{list_devices, open, report, reports};
pub use calibration::RgbdCalibration;
pub use library::{LibraryReport, LibraryState};
pub use selection::{DeviceEntry, NativeKind, Selection};
