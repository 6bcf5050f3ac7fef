//! `sensor_msgs/Image` and `sensor_msgs/CompressedImage`, of colour and depth.

mod compressed_depth;

pub use compressed_depth::{compressed_depth_from_ros, compressed_depth_to_ros};

use super::stamp;
use crate::generated::sensor_msgs::{CompressedImage, ImageMessage};
use crate::generated::std_msgs::Header;
use crate::wire::Bytes;
use trundle_core::{ColorImage, DepthImage, Invalid, Stamp};
use trundle_drivers::camera::{PixelFormat, RawImage};

/// Encodings of colour images \[sensor_msgs/image_encodings\].
const COLORS: [(&str, PixelFormat); 9] = [
    ("rgb8", PixelFormat::Rgb8),
    ("bgr8", PixelFormat::Bgr8),
    ("rgba8", PixelFormat::Rgba8),
    ("bgra8", PixelFormat::Bgra8),
    ("mono8", PixelFormat::Gray8),
    ("8UC1", PixelFormat::Gray8),
    ("8UC3", PixelFormat::Bgr8),
    ("yuv422_yuy2", PixelFormat::Yuyv),
    ("yuv422", PixelFormat::Uyvy),
];
/// Encodings of depth images \[REP 118\]: millimetres, or metres.
const DEPTHS: [(&str, PixelFormat); 3] =
    [("16UC1", PixelFormat::Depth16), ("mono16", PixelFormat::Depth16), ("32FC1", PixelFormat::DepthF32)];
/// The first bytes of a JPEG file. Source: ITU-T T.81, B.1.1.3.
const JPEG_MAGIC: [u8; 3] = [0xFF, 0xD8, 0xFF];

/// A colour image.
///
/// # Errors
/// When the encoding is no colour encoding, or the number of bytes does not fit the size.
pub fn color_from_ros(image: ImageMessage) -> Result<RawImage, Invalid> {
    raw_from_ros(image, &COLORS, "rgb8, bgr8, rgba8, bgra8, mono8, yuv422 or yuv422_yuy2")
}

/// A depth image.
///
/// # Errors
/// When the encoding is no depth encoding, or the number of bytes does not fit the size.
pub fn depth_from_ros(image: ImageMessage) -> Result<RawImage, Invalid> {
    raw_from_ros(image, &DEPTHS, "16UC1 (mm) or 32FC1 (m)")
}

fn raw_from_ros(
    image: ImageMessage,
    known: &[(&str, PixelFormat)],
    expected: &str,
) -> Result<RawImage, Invalid> {
    let encoding = known.iter().find(|(name, _)| *name == image.encoding);
    let Some((_, format)) = encoding else {
        return Err(Invalid::new("encoding", format!("'{}'", image.encoding), "", expected));
    };
    if image.is_bigendian != 0 && matches!(format, PixelFormat::Depth16 | PixelFormat::DepthF32) {
        return Err(Invalid::new("is_bigendian", image.is_bigendian, "", "0"));
    }
    let (width, height, stride) = (image.width as usize, image.height as usize, image.step as usize);
    let bytes_per_row = format.bytes_per_pixel().unwrap_or_default().saturating_mul(width);
    if width == 0 || height == 0 {
        return Err(Invalid::new("image size", format!("{width} x {height}"), "px", "at least 1 x 1"));
    }
    if stride < bytes_per_row {
        return Err(Invalid::new("step", stride, "bytes", format!("at least {bytes_per_row}")));
    }
    if stride.checked_mul(height) != Some(image.data.0.len()) {
        return Err(Invalid::new(
            "number of bytes",
            image.data.0.len(),
            "",
            format!("step x height, {stride} x {height}"),
        ));
    }
    let device_stamp = stamp::from_ros(&image.header.stamp)?;
    Ok(RawImage { format: *format, width, height, stride, bytes: image.data.0, device_stamp })
}

/// A compressed colour image of `size` \[px\]: a JPEG file.
///
/// # Errors
/// When the file is not a JPEG.
pub fn compressed_color_from_ros(image: CompressedImage, size: (usize, usize)) -> Result<RawImage, Invalid> {
    if !image.data.0.starts_with(&JPEG_MAGIC) {
        let expected = "a JPEG file: set the publisher's parameter of the compressed transport to jpeg";
        return Err(Invalid::new("format", format!("'{}'", image.format), "", expected));
    }
    let device_stamp = stamp::from_ros(&image.header.stamp)?;
    Ok(RawImage::packed(PixelFormat::Mjpg, size, image.data.0, device_stamp))
}

/// A colour image as a message.
#[must_use]
pub fn color_to_ros(image: &ColorImage, at: Stamp, frame: &str) -> ImageMessage {
    to_ros(image, "rgb8", image.data().as_flattened().to_vec(), stamp::header(at, frame))
}

/// A depth image as a message in millimetres.
#[must_use]
pub fn depth_to_ros(image: &DepthImage, at: Stamp, frame: &str) -> ImageMessage {
    let millimetres =
        |depth: &f32| ((depth * 1000.0).round().clamp(0.0, f32::from(u16::MAX)) as u16).to_le_bytes();
    to_ros(image, "16UC1", image.data().iter().flat_map(millimetres).collect(), stamp::header(at, frame))
}

/// Bytes of the size of `image`, rows without a gap.
fn to_ros<T>(image: &trundle_core::Image<T>, encoding: &str, bytes: Vec<u8>, header: Header) -> ImageMessage {
    ImageMessage {
        header,
        height: image.height() as u32,
        width: image.width() as u32,
        encoding: encoding.to_owned(),
        is_bigendian: 0,
        step: (bytes.len() / image.height().max(1)) as u32,
        data: Bytes(bytes),
    }
}

/// A colour image as a JPEG file in a message. `jpeg` holds the file.
#[must_use]
pub fn jpeg_to_ros(jpeg: Vec<u8>, at: Stamp, frame: &str) -> CompressedImage {
    let format = "rgb8; jpeg compressed bgr8".to_owned();
    CompressedImage { header: stamp::header(at, frame), format, data: Bytes(jpeg) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depth() -> DepthImage {
        DepthImage::new(2, 1, vec![1.5, 0.0]).unwrap()
    }

    #[test]
    fn images_go_there_and_back() {
        let color = ColorImage::new(1, 2, vec![[1, 2, 3], [4, 5, 6]]).unwrap();
        let raw = color_from_ros(color_to_ros(&color, Stamp::from_nanos(7), "camera")).unwrap();
        assert_eq!(
            (raw.bytes, raw.format, raw.device_stamp.nanos),
            (vec![1, 2, 3, 4, 5, 6], PixelFormat::Rgb8, 7)
        );
        let raw = depth_from_ros(depth_to_ros(&depth(), Stamp::default(), "camera")).unwrap();
        assert_eq!((raw.bytes, raw.format), (vec![0xDC, 0x05, 0, 0], PixelFormat::Depth16));
    }

    #[test]
    fn wrong_encodings_and_sizes_are_refused() {
        let image = || depth_to_ros(&depth(), Stamp::default(), "camera");
        assert!(
            color_from_ros(image())
                .unwrap_err()
                .to_string()
                .starts_with("encoding is '16UC1', expected rgb8")
        );
        let refused = |image| depth_from_ros(image).unwrap_err().to_string();
        assert!(refused(ImageMessage { encoding: "bayer_rggb8".into(), ..image() }).contains("bayer_rggb8"));
        assert!(refused(ImageMessage { height: u32::MAX, ..image() }).starts_with("number of bytes is 4"));
        assert!(refused(ImageMessage { step: 1, ..image() }).starts_with("step is 1 bytes"));
        assert!(refused(ImageMessage { width: 0, ..image() }).starts_with("image size is 0 x 1"));
        assert!(refused(ImageMessage { is_bigendian: 1, ..image() }).starts_with("is_bigendian"));
        let png = CompressedImage { format: "png".into(), ..CompressedImage::default() };
        assert!(
            compressed_color_from_ros(png, (1, 1)).unwrap_err().to_string().starts_with("format is 'png'")
        );
    }
}
