//! `sensor_msgs/msg/Image` and `CompressedImage`: colour and depth images of a bag.

use super::compressed_depth::{decode_compressed_depth, is_compressed_depth};
use super::pixels::{color_of_raw, depth_of_raw, is_raw_color, is_raw_depth};
use super::raw_image::RawImage;
use crate::codec::{CodecError, decode_color, decode_depth_file, is_depth_image};
use crate::ros::cdr::{CdrError, CdrReader, Wire};
use crate::ros::messages::{header, types};
use trundle_core::{ColorImage, DepthImage, Stamp};

/// An image of a bag, not decoded.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BagImage {
    pub(super) stamp: Stamp,
    pub(super) frame: String,
    content: Content,
}

#[derive(Debug, Clone, PartialEq)]
enum Content {
    Raw(RawImage),
    Compressed { format: String, bytes: Vec<u8> },
}

/// Content of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ImageKind {
    Color,
    /// Brightness only: used as colour if no colour exists.
    Grey,
    Depth,
    /// An encoding that is not read.
    Other,
}

impl BagImage {
    /// The image of a message of type `kind`; `None` for another type.
    pub(super) fn read(kind: &str, bytes: &[u8], wire: Wire) -> Option<Result<Self, CdrError>> {
        match kind {
            types::IMAGE => Some(Self::read_raw(bytes, wire)),
            types::COMPRESSED_IMAGE => Some(Self::read_compressed(bytes, wire)),
            _ => None,
        }
    }

    fn read_raw(bytes: &[u8], wire: Wire) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::IMAGE, bytes, wire)?;
        let (stamp, frame) = header(&mut r)?;
        let (height, width) = (r.u32("height")? as usize, r.u32("width")? as usize);
        let encoding = r.string("encoding")?;
        let is_big_endian = r.u8("is_bigendian")? != 0;
        let step = r.u32("step")? as usize;
        let data = r.bytes("data")?.to_vec();
        let image = RawImage { width, height, encoding, is_big_endian, step, data };
        Ok(Self { stamp, frame, content: Content::Raw(image) })
    }

    fn read_compressed(bytes: &[u8], wire: Wire) -> Result<Self, CdrError> {
        let mut r = CdrReader::new(types::COMPRESSED_IMAGE, bytes, wire)?;
        let (stamp, frame) = header(&mut r)?;
        let format = r.string("format")?;
        let bytes = r.bytes("data")?.to_vec();
        Ok(Self { stamp, frame, content: Content::Compressed { format, bytes } })
    }

    /// Content of the image, by its encoding and its first bytes.
    pub(super) fn kind(&self) -> ImageKind {
        match &self.content {
            Content::Raw(raw) if is_raw_depth(&raw.encoding) => ImageKind::Depth,
            Content::Raw(raw) if raw.encoding == "mono8" || raw.encoding == "8UC1" => ImageKind::Grey,
            Content::Raw(raw) if is_raw_color(&raw.encoding) => ImageKind::Color,
            Content::Raw(_) => ImageKind::Other,
            Content::Compressed { format, .. } if is_compressed_depth(format) => ImageKind::Depth,
            Content::Compressed { bytes, .. } if is_depth_image(bytes) => ImageKind::Depth,
            Content::Compressed { format, .. } if format.starts_with("mono8") => ImageKind::Grey,
            Content::Compressed { bytes, .. } if is_picture(bytes) => ImageKind::Color,
            Content::Compressed { .. } => ImageKind::Other,
        }
    }

    /// The encoding, for messages.
    pub(super) fn encoding(&self) -> &str {
        match &self.content {
            Content::Raw(raw) => &raw.encoding,
            Content::Compressed { format, .. } => format,
        }
    }

    /// Size of the content \[bytes\].
    pub(super) fn byte_count(&self) -> usize {
        match &self.content {
            Content::Raw(raw) => raw.data.len(),
            Content::Compressed { bytes, .. } => bytes.len(),
        }
    }

    /// The colour image; grey images become grey colours.
    pub(super) fn color(&self) -> Result<ColorImage, CodecError> {
        match &self.content {
            Content::Raw(raw) => color_of_raw(raw),
            Content::Compressed { bytes, .. } => decode_color(bytes),
        }
    }

    /// The JPEG of a colour image, if it is one.
    pub(super) fn jpeg(&self) -> Option<&[u8]> {
        match &self.content {
            Content::Compressed { bytes, .. } if bytes.starts_with(JPEG_MAGIC) => Some(bytes),
            _ => None,
        }
    }

    /// Depth in metres, 0 for unknown. `depth_scale`: units per metre of whole-numbered images.
    pub(super) fn depth(&self, depth_scale: f64) -> Result<DepthImage, CodecError> {
        match &self.content {
            Content::Raw(raw) => depth_of_raw(raw, depth_scale),
            Content::Compressed { format, bytes } if is_compressed_depth(format) => {
                decode_compressed_depth(format, bytes, depth_scale)
            }
            Content::Compressed { bytes, .. } => decode_depth_file(bytes, depth_scale),
        }
    }
}

/// First bytes of a JPEG. Source: ITU-T T.81, B.1.1.3.
const JPEG_MAGIC: &[u8] = b"\xff\xd8\xff";

fn is_picture(bytes: &[u8]) -> bool {
    bytes.starts_with(JPEG_MAGIC) || bytes.starts_with(b"\x89PNG\r\n\x1a\n")
}
