//! Pixel formats.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Form of the pixels of a [`super::RawImage`]. Numbers of more than one byte are little endian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PixelFormat {
    /// Red, green, blue.
    Rgb8,
    /// Blue, green, red.
    Bgr8,
    /// Red, green, blue, unused.
    Rgba8,
    /// Blue, green, red, unused.
    Bgra8,
    /// Y0 U Y1 V for two pixels (YUY2), BT.601, limited range.
    Yuyv,
    /// U Y0 V Y1 for two pixels, BT.601, limited range.
    Uyvy,
    /// A JPEG file for each image.
    Mjpg,
    /// Luminance.
    Gray8,
    /// Depth in whole numbers of 16 bits; the unit is [`super::CameraInfo::depth_unit_m`]; 0 for unknown.
    Depth16,
    /// Depth in metres as a 32-bit float; 0, NaN or infinite for unknown.
    DepthF32,
    /// Raw disparity of the Kinect v1, 11 bits in 16; 2047 for unknown.
    Disparity11,
    /// A PNG file of one 16-bit channel; values as in [`PixelFormat::Depth16`].
    DepthPng16,
}

impl PixelFormat {
    /// Whether the pixels are depths.
    pub fn is_depth(self) -> bool {
        matches!(self, Self::Depth16 | Self::DepthF32 | Self::Disparity11 | Self::DepthPng16)
    }

    /// Bytes of one pixel; `None` for compressed formats, whose size varies.
    pub fn bytes_per_pixel(self) -> Option<usize> {
        match self {
            Self::Gray8 => Some(1),
            Self::Yuyv | Self::Uyvy | Self::Depth16 | Self::Disparity11 => Some(2),
            Self::Rgb8 | Self::Bgr8 => Some(3),
            Self::Rgba8 | Self::Bgra8 | Self::DepthF32 => Some(4),
            Self::Mjpg | Self::DepthPng16 => None,
        }
    }
}

/// The name in settings and stream headers, as `rgb8`.
impl fmt::Display for PixelFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rgb8 => "rgb8",
            Self::Bgr8 => "bgr8",
            Self::Rgba8 => "rgba8",
            Self::Bgra8 => "bgra8",
            Self::Yuyv => "yuyv",
            Self::Uyvy => "uyvy",
            Self::Mjpg => "mjpg",
            Self::Gray8 => "gray8",
            Self::Depth16 => "depth16",
            Self::DepthF32 => "depth_f32",
            Self::Disparity11 => "disparity11",
            Self::DepthPng16 => "depth_png16",
        })
    }
}
