//! `compressedDepth` images: a head of 12 bytes and a PNG file \[compressed_depth_image_transport\].

use super::stamp;
use crate::generated::sensor_msgs::CompressedImage;
use crate::wire::Bytes;
use trundle_core::{Invalid, Stamp};
use trundle_drivers::camera::{PixelFormat, RawImage};

/// Length of the head \[bytes\]: a format number and two parameters of the quantisation, of 4 bytes each.
const HEAD_BYTES: usize = 12;
/// The first bytes of a PNG file.
const PNG_MAGIC: [u8; 4] = [0x89, b'P', b'N', b'G'];

/// A compressed depth image of `size` \[px\]. Of `16UC1` the file is passed on as it is; `32FC1` is decoded: the values are inverse depths.
///
/// # Errors
/// When the file is no PNG, or of another size.
pub fn compressed_depth_from_ros(image: CompressedImage, size: (usize, usize)) -> Result<RawImage, Invalid> {
    let device_stamp = stamp::from_ros(&image.header.stamp)?;
    let data = image.data.0;
    let has_head = !data.starts_with(&PNG_MAGIC);
    let start = if has_head { HEAD_BYTES } else { 0 };
    if !data.get(start..).is_some_and(|png| png.starts_with(&PNG_MAGIC)) {
        let value = format!("'{}' of {} bytes", image.format, data.len());
        return Err(Invalid::new(
            "format",
            value,
            "",
            "a PNG file: set the publisher's compressedDepth format to png",
        ));
    }
    let png = data[start..].to_vec();
    if !image.format.starts_with("32FC1") {
        return Ok(RawImage::packed(PixelFormat::DepthPng16, size, png, device_stamp));
    }
    let number =
        |at: usize| data.get(at..at + 4).and_then(|b| b.try_into().ok()).map_or(0.0, f32::from_le_bytes);
    let (scale, offset) = if has_head { (number(4), number(8)) } else { (0.0, 0.0) };
    let bytes = metres(&png, size, scale, offset)?;
    Ok(RawImage::packed(PixelFormat::DepthF32, size, bytes, device_stamp))
}

/// Depths \[m\] as bytes of 32-bit floats: scale / (value - offset), 0 where the value is 0.
fn metres(png: &[u8], (width, height): (usize, usize), scale: f32, offset: f32) -> Result<Vec<u8>, Invalid> {
    let values = trundle_io::decode_raw_depth(png)
        .map_err(|error| Invalid::new("PNG file", error, "", "a whole file"))?;
    if (values.width(), values.height()) != (width, height) {
        let value = format!("{} x {}", values.width(), values.height());
        return Err(Invalid::new(
            "depth image size",
            value,
            "px",
            format!("{width} x {height} as camera_info"),
        ));
    }
    let depth = |value: &u16| if *value == 0 { 0.0 } else { scale / (f32::from(*value) - offset) };
    Ok(values.data().iter().flat_map(|value| depth(value).to_le_bytes()).collect())
}

/// Depth in millimetres, a PNG file of 16 bits, as a message.
#[must_use]
pub fn compressed_depth_to_ros(png: &[u8], at: Stamp, frame: &str) -> CompressedImage {
    let mut data = vec![0; HEAD_BYTES];
    data.extend_from_slice(png);
    let format = "16UC1; compressedDepth png".to_owned();
    CompressedImage { header: stamp::header(at, frame), format, data: Bytes(data) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_of_16_bits_is_passed_on_and_other_formats_are_refused() {
        let png = [&PNG_MAGIC[..], &[1, 2, 3]].concat();
        let message = compressed_depth_to_ros(&png, Stamp::from_nanos(3), "camera");
        let raw = compressed_depth_from_ros(message.clone(), (4, 2)).unwrap();
        assert_eq!((raw.bytes.as_slice(), raw.format), (&png[..], PixelFormat::DepthPng16));
        for data in [vec![], vec![0; 40]] {
            let rvl = CompressedImage {
                format: "16UC1; compressedDepth rvl".into(),
                data: Bytes(data),
                ..message.clone()
            };
            assert!(compressed_depth_from_ros(rvl, (4, 2)).unwrap_err().to_string().contains("rvl"));
        }
        let broken = CompressedImage { format: "32FC1; compressedDepth png".into(), ..message };
        assert!(compressed_depth_from_ros(broken, (4, 2)).unwrap_err().to_string().starts_with("PNG file"));
    }
}
