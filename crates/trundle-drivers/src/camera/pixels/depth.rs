//! Depth images from raw bytes.

use super::{compressed, raw_rows};
use crate::camera::{PixelFormat, RawImage};
use trundle_core::{DepthImage, Invalid, require_positive};

/// Slope of the inverse depth of a Kinect v1 over its raw disparity \[1/m\]. Source: \[OpenKinect\]:
/// depth = 1 / (raw * -0.0030711016 + 3.3309495161).
const DISPARITY_SLOPE: f64 = -0.003_071_101_6;
/// Inverse depth of a Kinect v1 at raw disparity 0 \[1/m\]. Source: \[OpenKinect\].
const DISPARITY_OFFSET: f64 = 3.330_949_516_1;
/// Raw disparity without a measurement. Source: \[OpenKinect\].
const NO_DISPARITY: u16 = 2047;
/// Largest depth that a Kinect v1 measures \[m\]; the formula has a pole at raw disparity 1085. Source: ours; one step of disparity is 0.3
/// m at this depth.
const MAX_DISPARITY_DEPTH_M: f64 = 10.0;

/// Converts `raw` into `image` (metres, 0 for unknown); the memory is reused if the size is equal. `unit_m` is the length of one unit of
/// whole-numbered depth \[m\].
///
/// # Errors
/// When the format is one of colour, the number of bytes does not match the size, the unit is not positive, or a PNG cannot be decoded.
pub fn depth_from_raw(raw: &RawImage, unit_m: f64, image: &mut DepthImage) -> Result<(), Invalid> {
    require_positive("unit of depth", unit_m, "m")?;
    let unit = unit_m as f32;
    match raw.format {
        PixelFormat::Depth16 => each(raw, image, |bytes| u16::from_le_bytes(bytes) as f32 * unit),
        PixelFormat::Disparity11 => {
            each(raw, image, |bytes| metres_from_disparity(u16::from_le_bytes(bytes)))
        }
        PixelFormat::DepthF32 => each(raw, image, |bytes| metres(f32::from_le_bytes(bytes))),
        PixelFormat::DepthPng16 => {
            let values = compressed::values_from_png(raw)?;
            resize(image, raw);
            let targets = image.data_mut().iter_mut();
            targets.zip(values.data()).for_each(|(target, value)| *target = *value as f32 * unit);
            Ok(())
        }
        color => Err(Invalid::new("pixel format of the depth image", color, "", "a depth format")),
    }
}

/// Depth \[m\] of a raw disparity of the Kinect v1; 0 for unknown or above 10 m.
pub fn metres_from_disparity(raw: u16) -> f32 {
    let inverse = raw as f64 * DISPARITY_SLOPE + DISPARITY_OFFSET;
    if raw >= NO_DISPARITY || inverse < 1.0 / MAX_DISPARITY_DEPTH_M { 0.0 } else { (1.0 / inverse) as f32 }
}

/// A depth that is finite and above 0; otherwise 0.
fn metres(depth: f32) -> f32 {
    if depth.is_finite() && depth > 0.0 { depth } else { 0.0 }
}

fn each<const BYTES: usize>(
    raw: &RawImage,
    image: &mut DepthImage,
    depth: impl Fn([u8; BYTES]) -> f32,
) -> Result<(), Invalid> {
    let rows = raw_rows::rows(raw)?;
    resize(image, raw);
    for (y, row) in rows.enumerate() {
        let (pixels, _) = row.as_chunks::<BYTES>();
        for (target, pixel) in image.row_mut(y).iter_mut().zip(pixels) {
            *target = depth(*pixel);
        }
    }
    Ok(())
}

fn resize(image: &mut DepthImage, raw: &RawImage) {
    if (image.width(), image.height()) != (raw.width, raw.height) {
        *image = DepthImage::filled(raw.width, raw.height, 0.0);
    }
}
