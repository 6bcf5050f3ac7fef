//! The images of a bag in pairs, in the order of their stamps: the second pass over it.

use super::image_message::BagImage;
use super::sequence_topics::RosImageTopics;
use crate::IoError;
use crate::codec::{CodecError, EncodedRgbd};
use crate::ros::bag::Bag;
use crate::ros::messages::types;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trundle_core::{RgbdImage, Stamp};

/// Maximum size of the images that wait for their partners \[bytes\]. A bag that needs more has colour and depth far apart and is refused.
/// Source: ours.
const MAX_WAITING_BYTES: usize = 1 << 29;

/// The pairs of a bag, one after the other.
pub struct RosFrames<'a> {
    path: PathBuf,
    bag: Bag,
    topics: &'a RosImageTopics,
    pairs: &'a [(Stamp, Stamp)],
    depth_scale: f64,
    colors: BTreeMap<Stamp, BagImage>,
    depths: BTreeMap<Stamp, BagImage>,
    waiting_bytes: usize,
}

/// A colour and a depth image of a bag, not decoded.
pub struct RosFrame {
    color: BagImage,
    depth: BagImage,
    depth_scale: f64,
}

impl<'a> RosFrames<'a> {
    pub(super) fn open(
        path: &Path,
        topics: &'a RosImageTopics,
        pairs: &'a [(Stamp, Stamp)],
        depth_scale: f64,
    ) -> Result<Self, IoError> {
        Ok(Self {
            path: path.to_owned(),
            bag: Bag::open(path)?,
            topics,
            pairs,
            depth_scale,
            colors: BTreeMap::new(),
            depths: BTreeMap::new(),
            waiting_bytes: 0,
        })
    }

    /// The next pair, if both images are read.
    fn ready(&mut self) -> Option<RosFrame> {
        let (color, depth) = *self.pairs.first()?;
        if !(self.colors.contains_key(&color) && self.depths.contains_key(&depth)) {
            return None;
        }
        let color = self.colors.remove(&color)?;
        let depth_image = self.depths.get(&depth)?.clone();
        self.waiting_bytes -= color.byte_count();
        self.pairs = &self.pairs[1..];
        // A depth image may be paired with the next colour image as well.
        if self.pairs.first().is_none_or(|(_, next)| *next != depth) {
            self.waiting_bytes -= depth_image.byte_count();
            self.depths.remove(&depth);
        }
        Some(RosFrame { color, depth: depth_image, depth_scale: self.depth_scale })
    }

    /// Reads the next message. Returns whether a message was read. A truncated bag ends at the same message as in the first pass.
    fn read_message(&mut self) -> Result<bool, IoError> {
        let Ok(Some(message)) = self.bag.next_message() else { return Ok(false) };
        let is_color = message.topic == self.topics.color;
        if !is_color && message.topic != self.topics.depth {
            return Ok(true);
        }
        let kind = types::canonical(&message.schema);
        let Some(Ok(image)) = BagImage::read(kind, &message.data, self.bag.wire()) else { return Ok(true) };
        self.keep(image, is_color);
        if self.waiting_bytes > MAX_WAITING_BYTES {
            let problem = format!(
                "colour on {} and depth on {} lie more than {MAX_WAITING_BYTES} bytes apart in the file, expected both in the order of \
                 time: `ros2 bag convert` sorts them",
                self.topics.color, self.topics.depth
            );
            return Err(IoError::malformed(&self.path, problem));
        }
        Ok(true)
    }

    /// Keeps an image that a pair needs. Of two images with one stamp the first is kept.
    fn keep(&mut self, image: BagImage, is_color: bool) {
        let stamp = image.stamp;
        let is_needed = match is_color {
            true => self.pairs.binary_search_by_key(&stamp, |(color, _)| *color).is_ok(),
            false => self.pairs.binary_search_by_key(&stamp, |(_, depth)| *depth).is_ok(),
        };
        let waiting = if is_color { &mut self.colors } else { &mut self.depths };
        if is_needed && !waiting.contains_key(&stamp) {
            self.waiting_bytes += image.byte_count();
            waiting.insert(stamp, image);
        }
    }
}

impl Iterator for RosFrames<'_> {
    type Item = Result<RosFrame, IoError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(frame) = self.ready() {
                return Some(Ok(frame));
            }
            match self.read_message() {
                Ok(true) => {}
                Ok(false) => return None,
                Err(error) => {
                    self.pairs = &[];
                    return Some(Err(error));
                }
            }
        }
    }
}

impl RosFrame {
    /// The stamp of the colour image.
    #[must_use]
    pub fn stamp(&self) -> Stamp {
        self.color.stamp
    }

    /// The image, depth in metres.
    ///
    /// # Errors
    /// When an image is damaged, of an encoding that is not read, or their sizes differ.
    pub fn decode(&self) -> Result<RgbdImage, CodecError> {
        let (color, depth) = (self.color.color()?, self.depth.depth(self.depth_scale)?);
        Ok(RgbdImage::of_registered(self.color.stamp, color, depth)?)
    }

    /// The bytes to record for the decoded `image`: an unchanged JPEG, and depth in millimetres.
    ///
    /// # Errors
    /// When the image cannot be encoded.
    pub fn encoded(&self, image: &RgbdImage) -> Result<EncodedRgbd, CodecError> {
        match self.color.jpeg() {
            Some(jpeg) => EncodedRgbd::with_jpeg(jpeg.to_vec(), image),
            None => EncodedRgbd::encode(image),
        }
    }
}
