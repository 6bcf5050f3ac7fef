//! `compressedDepth` images: a head of 12 bytes and a PNG file or RVL \[compressed_depth_image_transport\].

use super::stamp;
use crate::generated::sensor_msgs::CompressedImage;
use crate::wire::Bytes;
use trundle_core::{Invalid, Stamp};
use trundle_drivers::camera::{PixelFormat, RawImage};
use trundle_io::decode_compressed_depth;

/// Length of the head \[bytes\]: a format number and two parameters of the quantisation, of 4 bytes each. Source:
/// `compressed_depth_image_transport`.
const HEAD_BYTES: usize = 12;
/// Units of a `16UC1` image in a metre. Source: REP 118.
const UNITS_PER_M: f64 = 1000.0;

/// A compressed depth image in metres.
///
/// # Errors
/// When the bytes are not a whole image of the transport, or its quantisation makes no depth.
pub fn compressed_depth_from_ros(image: CompressedImage) -> Result<RawImage, Invalid> {
    let device_stamp = stamp::from_ros(&image.header.stamp)?;
    let depth = decode_compressed_depth(&image.format, &image.data.0, UNITS_PER_M).map_err(|error| {
        let value = format!("'{}': {error}", image.format);
        Invalid::new("format", value, "", "compressedDepth in PNG or RVL")
    })?;
    let bytes = depth.data().iter().flat_map(|metres| metres.to_le_bytes()).collect();
    Ok(RawImage::packed(PixelFormat::DepthF32, (depth.width(), depth.height()), bytes, device_stamp))
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
    use trundle_core::DepthImage;
    use trundle_io::{encode_depth, encode_depth_rvl};

    fn depth() -> DepthImage {
        DepthImage::new(2, 1, vec![1.5, 0.0]).unwrap()
    }

    #[test]
    fn png_and_rvl_are_decoded_to_metres_and_other_bytes_are_refused() {
        let png = compressed_depth_to_ros(&encode_depth(&depth()).unwrap(), Stamp::from_nanos(3), "camera");
        let rvl_data = [vec![0; HEAD_BYTES], encode_depth_rvl(&depth()).unwrap()].concat();
        let rvl = CompressedImage {
            format: "16UC1; compressedDepth rvl".into(),
            data: Bytes(rvl_data),
            ..png.clone()
        };
        for message in [png.clone(), rvl] {
            let raw = compressed_depth_from_ros(message).unwrap();
            assert_eq!((raw.width, raw.height, raw.format), (2, 1, PixelFormat::DepthF32));
            assert_eq!(raw.bytes, [1.5_f32.to_le_bytes(), 0_f32.to_le_bytes()].concat());
            assert_eq!(raw.device_stamp.nanos, 3);
        }
        for data in [vec![], vec![0; 40]] {
            let broken = CompressedImage { data: Bytes(data), ..png.clone() };
            let error = compressed_depth_from_ros(broken).unwrap_err().to_string();
            assert!(error.starts_with("format is '16UC1; compressedDepth png': "), "{error}");
        }
    }

    #[test]
    fn a_quantisation_that_makes_no_depth_is_refused() {
        let png = compressed_depth_to_ros(&encode_depth(&depth()).unwrap(), Stamp::default(), "camera");
        let broken = CompressedImage { format: "32FC1; compressedDepth png".into(), ..png };
        let error = compressed_depth_from_ros(broken).unwrap_err().to_string();
        assert!(error.contains("the quantisation is 0, 0"), "{error}");
    }
}
