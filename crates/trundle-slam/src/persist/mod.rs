//! Maps on disk: saved as bytes, loaded with every number checked.
//!
//! | bytes | |
//! |---|---|
//! | 7 | `trundlM` |
//! | 1 | version |
//! | 8 | checksum of the rest (FNV-1a by words of 8 bytes) |
//! | 18 x 8 | camera and ORB settings, f64 |
//! | 4, then each | number of maps; a map: its number, keyframes with the odometry between them, the axis of the floor, landmarks with their observations and reference patches, loops |
//!
//! All numbers are little endian. Derived data is not saved: rectified pixels, bags of words, spanning tree. The trajectory is not part of
//! a map.

pub(crate) mod bytes;
pub(crate) mod error;
pub(crate) mod frame;
pub(crate) mod map;
pub(crate) mod map_file;
pub(crate) mod reference_patch;
pub(crate) mod settings;
