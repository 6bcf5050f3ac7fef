//! The images of a recording: their messages, and the pairs of colour and depth that wait for their place among the events.

use crate::codec::EncodedRgbd;
use crate::ros::{CdrReader, Wire, header};
use std::collections::VecDeque;
use trundle_core::Stamp;

/// The name of the message.
pub(super) const SCHEMA: &str = "sensor_msgs/msg/CompressedImage";

/// Bytes in front of the image of a `compressedDepth` message. Source: `compressed_depth_image_transport`.
const DEPTH_HEADER_BYTES: usize = 12;
/// Maximum number of images that wait for their place; a recording by trundle never exceeds it. Source: ours, ten times those of a chunk.
const MAX_WAITING: usize = 4096;

/// An image's bytes and the stamp of its message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ImageBytes {
    pub stamp: Stamp,
    pub bytes: Vec<u8>,
}

/// The image of a `sensor_msgs/msg/CompressedImage`; of depth without the header of its transport.
///
/// # Errors
/// The problem, in words.
pub(super) fn decode(message: &[u8]) -> Result<ImageBytes, String> {
    let read = || {
        let mut reader = CdrReader::new(SCHEMA, message, Wire::Cdr)?;
        let (stamp, _) = header(&mut reader)?;
        let format = reader.string("format")?;
        Ok((stamp, format, reader.bytes("data")?))
    };
    let (stamp, format, bytes) = read().map_err(|error: crate::ros::CdrError| error.to_string())?;
    let bytes = match format.contains("compressedDepth") {
        true => bytes.get(DEPTH_HEADER_BYTES..).ok_or("the depth image is cut")?,
        false => bytes,
    };
    Ok(ImageBytes { stamp, bytes: bytes.to_vec() })
}

/// Images that were read and whose place among the events was not.
#[derive(Default)]
pub(super) struct WaitingImages {
    colors: VecDeque<ImageBytes>,
    depths: VecDeque<ImageBytes>,
}

impl WaitingImages {
    /// Keeps a colour image, or a depth image.
    ///
    /// # Errors
    /// When the number of waiting images exceeds the limit.
    pub(super) fn push(&mut self, image: ImageBytes, is_color: bool) -> Result<(), String> {
        let waiting = if is_color { &mut self.colors } else { &mut self.depths };
        waiting.push_back(image);
        if waiting.len() > MAX_WAITING {
            return Err(format!("more than {MAX_WAITING} images without their place among the events"));
        }
        Ok(())
    }

    /// The oldest pair, which came at `stamp`.
    ///
    /// # Errors
    /// When colour or depth is missing, or is of another stamp.
    pub(super) fn pop(&mut self, stamp: Stamp) -> Result<EncodedRgbd, String> {
        let mut take = |is_color: bool| {
            let (name, waiting) =
                if is_color { ("colour", &mut self.colors) } else { ("depth", &mut self.depths) };
            let image = waiting.pop_front().ok_or_else(|| format!("no {name} image for {stamp} s"))?;
            if image.stamp != stamp {
                return Err(format!(
                    "a {name} image of {} s where one of {stamp} s is expected",
                    image.stamp
                ));
            }
            Ok(image.bytes)
        };
        Ok(EncodedRgbd { stamp, color_jpeg: take(true)?, depth: take(false)? })
    }
}
