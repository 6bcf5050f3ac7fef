//! Cameras through the libraries of their makers, which are loaded at run time.
//!
//! | module | content |
//! |---|---|
//! | [`library`] | search, version and functions of a library |
//! | [`realsense`] | RealSense D4xx, librealsense2 |
//! | [`distortion_fit`] | lens models of other makers as [`trundle_core::Distortion`] |
//! | [`selection`] | which camera to open |

pub mod distortion_fit;
pub mod freenect;
pub mod library;
pub mod orbbec;
pub mod realsense;
pub mod selection;

pub use library::{LibraryReport, LibraryState};
pub use selection::{DeviceEntry, NativeKind, Selection};
