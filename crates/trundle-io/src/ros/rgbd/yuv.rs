//! Colours of YUV images: packed 4:2:2 and planar 4:2:0.

use super::raw_image::RawImage;
use crate::codec::CodecError;
use trundle_core::ColorImage;

/// The order of the bytes of a YUV image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Yuv {
    /// Two pixels in four bytes; positions of the first Y, the second Y, U and V.
    Packed([usize; 4]),
    /// All Y, then U and V of two by two pixels alternately; positions of U and V.
    TwoPlanes([usize; 2]),
}

impl Yuv {
    /// The form of an encoding of ROS.
    pub(super) fn named(encoding: &str) -> Option<Self> {
        Some(match encoding {
            "yuv422" | "uyvy" => Self::Packed([1, 3, 0, 2]),
            "yuv422_yuy2" | "yuyv" => Self::Packed([0, 2, 1, 3]),
            "nv12" => Self::TwoPlanes([0, 1]),
            "nv21" => Self::TwoPlanes([1, 0]),
            _ => return None,
        })
    }
}

/// The colours of an image of an even width.
///
/// # Errors
/// When the width is odd, or the bytes are too few for the size.
pub(super) fn color_of_yuv(raw: &RawImage, form: Yuv) -> Result<ColorImage, CodecError> {
    if !raw.width.is_multiple_of(2) {
        let problem = format!("'{}' of an odd width of {} px", raw.encoding, raw.width);
        return Err(CodecError::decode("colour", problem));
    }
    let pixels = match form {
        Yuv::Packed([first, second, u, v]) => raw
            .rows("colour", 2)?
            .flat_map(|row| row.as_chunks::<4>().0)
            .flat_map(|p| [rgb(p[first], p[u], p[v]), rgb(p[second], p[u], p[v])])
            .collect(),
        Yuv::TwoPlanes([u, v]) => two_planes(raw, (u, v))?,
    };
    Ok(ColorImage::new(raw.width, raw.height, pixels)?)
}

fn two_planes(raw: &RawImage, (u, v): (usize, usize)) -> Result<Vec<[u8; 3]>, CodecError> {
    let rows: Vec<&[u8]> = raw.rows("colour", 1)?.collect();
    let colors = raw.data.get(raw.step * raw.height..).unwrap_or_default();
    if colors.len() < raw.step * raw.height.div_ceil(2) {
        let problem = format!("'{}': {} bytes hold no colours", raw.encoding, raw.data.len());
        return Err(CodecError::decode("colour", problem));
    }
    let pixel = |y: usize, x: usize| {
        let at = y / 2 * raw.step + x / 2 * 2;
        rgb(rows[y][x], colors[at + u], colors[at + v])
    };
    Ok((0..raw.height).flat_map(|y| (0..raw.width).map(move |x| (y, x))).map(|(y, x)| pixel(y, x)).collect())
}

/// Red, green and blue of ITU-R BT.601, whose Y is from 16 to 235.
fn rgb(y: u8, u: u8, v: u8) -> [u8; 3] {
    let luma = 1.164_383 * (f32::from(y) - 16.0);
    let (u, v) = (f32::from(u) - 128.0, f32::from(v) - 128.0);
    let to_byte = |value: f32| value.round().clamp(0.0, 255.0) as u8;
    [
        to_byte(luma + 1.596_027 * v),
        to_byte(luma - 0.391_762 * u - 0.812_968 * v),
        to_byte(luma + 2.017_232 * u),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_red_and_black_in_every_form() {
        // Red of BT.601: Y 81, U 90, V 240.
        let image = |encoding: &str, data: &[u8], height| RawImage {
            width: 2,
            height,
            encoding: encoding.to_owned(),
            is_big_endian: false,
            step: if encoding.starts_with("nv") { 2 } else { 4 },
            data: data.to_vec(),
        };
        let color = |raw: &RawImage| color_of_yuv(raw, Yuv::named(&raw.encoding).unwrap());
        for raw in [
            image("yuv422", &[90, 81, 240, 81], 1),
            image("yuv422_yuy2", &[81, 90, 81, 240], 1),
            image("nv12", &[81, 81, 81, 81, 90, 240], 2),
            image("nv21", &[81, 81, 81, 81, 240, 90], 2),
        ] {
            for pixel in color(&raw).unwrap().data() {
                assert!(pixel[0] > 250 && pixel[1] < 5 && pixel[2] < 5, "{}: {pixel:?}", raw.encoding);
            }
        }
        assert_eq!(rgb(16, 128, 128), [0; 3]);
        assert_eq!(rgb(235, 128, 128), [255; 3]);
        assert!(color(&image("nv12", &[81, 81, 81, 81, 90], 2)).is_err());
        assert!(color(&RawImage { width: 1, ..image("yuv422", &[0; 8], 1) }).is_err());
    }
}
