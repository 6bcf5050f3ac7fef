//! Pixel formats to images of [`trundle_core`].
//!
//! Both converters reuse their image: after the first frame only the decoders of JPEG and PNG allocate memory.

mod bt601;
mod color;
mod compressed;
mod depth;
mod raw_rows;

pub use bt601::rgb_from_yuv;
pub use color::color_from_raw;
pub use depth::{depth_from_raw, metres_from_disparity};
