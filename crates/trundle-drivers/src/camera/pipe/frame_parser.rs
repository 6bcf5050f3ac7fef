//! Frames cut out of a stream of bytes.
//!
//! A frame begins with a magic word and the lengths of its two images. Bytes that do not fit are skipped up to the next magic word: the
//! stream recovers after lost or foreign bytes. The lengths are checked against the header of the stream, which bounds the memory.

use crate::camera::{CameraFrame, CameraInfo, PixelFormat, RawImage, StreamInfo};
use trundle_core::{Invalid, Stamp};

/// First bytes of each frame. Source: docs/camera-stream.md.
pub const FRAME_MAGIC: [u8; 4] = *b"TRFR";
/// Bytes before the images: magic, stamp (i64), length of colour (u32), length of depth (u32). Source: docs/camera-stream.md.
pub(super) const FRAME_HEADER_BYTES: usize = 20;
/// Bytes by which a compressed image may exceed its uncompressed size: 65536. Source: ours; headers and tables of a file.
const COMPRESSED_EXTRA_BYTES: usize = 65_536;
/// Bytes of a pixel of a compressed image before compression, at most: 4. Source: ours.
const MAX_BYTES_PER_PIXEL: usize = 4;

/// A frame as cut out of the stream.
#[derive(Debug, Clone, PartialEq)]
pub struct StreamFrame {
    /// Time on the camera's clock.
    pub stamp: Stamp,
    /// Bytes of the colour image.
    pub color: Vec<u8>,
    /// Bytes of the depth image.
    pub depth: Vec<u8>,
}

impl StreamFrame {
    /// The frame of a camera with the streams of `info`.
    pub fn into_camera_frame(self, info: &CameraInfo) -> CameraFrame {
        let image = |stream: &StreamInfo, bytes| {
            let size = (stream.camera.width(), stream.camera.height());
            RawImage::packed(stream.format, size, bytes, self.stamp)
        };
        CameraFrame { color: image(&info.color, self.color), depth: image(&info.depth, self.depth) }
    }
}

/// Accepted lengths of the two images of a frame \[bytes\], ends included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameLimits {
    /// Minimum and maximum length of the colour image.
    pub color: (usize, usize),
    /// Minimum and maximum length of the depth image.
    pub depth: (usize, usize),
}

impl FrameLimits {
    /// Limits for the streams of a camera: exact for uncompressed formats.
    pub fn of(info: &CameraInfo) -> Self {
        Self { color: limits(&info.color), depth: limits(&info.depth) }
    }
}

fn limits(stream: &StreamInfo) -> (usize, usize) {
    let pixels = stream.camera.width() * stream.camera.height();
    let exact = |format: PixelFormat| format.bytes_per_pixel().map(|bytes| pixels * bytes);
    let largest = pixels * MAX_BYTES_PER_PIXEL + COMPRESSED_EXTRA_BYTES;
    exact(stream.format).map_or((1, largest), |length| (length, length))
}

/// Counts of bytes and frames that a parser skipped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ParserCounts {
    /// Frames found.
    pub frames: u64,
    /// Bytes that belong to no frame.
    pub skipped_bytes: u64,
    /// Frames with images of another length than the stream's header promises.
    pub wrong_lengths: u64,
}

/// Extracts frames from a stream of bytes. It stores at most one frame and one push.
#[derive(Debug, Clone)]
pub struct FrameParser {
    limits: FrameLimits,
    bytes: Vec<u8>,
    start: usize,
    counts: ParserCounts,
    /// Refused lengths of colour and depth of the last refused frame.
    refused: Option<(usize, usize)>,
}

/// Kind of the first bytes.
enum Front {
    /// A frame with lengths of colour and depth.
    Frame(Stamp, usize, usize),
    /// Too few bytes for a decision.
    Incomplete,
    /// A frame's header with lengths that the stream cannot have.
    WrongLengths(usize, usize),
    /// No frame.
    Foreign,
}

impl FrameParser {
    /// For frames within `limits`.
    pub fn new(limits: FrameLimits) -> Self {
        Self { limits, bytes: Vec::new(), start: 0, counts: ParserCounts::default(), refused: None }
    }

    /// Appends bytes of the stream. Call [`FrameParser::next_frame`] until it gives `None` before the next push.
    pub fn push(&mut self, bytes: &[u8]) {
        if self.start > 0 {
            self.bytes.drain(..self.start);
            self.start = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// The next whole frame; `None` if more bytes are needed.
    pub fn next_frame(&mut self) -> Option<StreamFrame> {
        loop {
            match self.front() {
                Front::Incomplete => return None,
                Front::Foreign => self.skip(),
                Front::WrongLengths(color, depth) => {
                    self.counts.wrong_lengths += 1;
                    self.refused = Some((color, depth));
                    self.skip();
                }
                Front::Frame(stamp, color, depth) => {
                    let images = self.bytes.get(self.start + FRAME_HEADER_BYTES..)?;
                    let images = images.get(..color + depth)?;
                    let (color, depth) = images.split_at(color);
                    let frame = StreamFrame { stamp, color: color.to_vec(), depth: depth.to_vec() };
                    self.start += FRAME_HEADER_BYTES + images.len();
                    self.counts.frames += 1;
                    return Some(frame);
                }
            }
        }
    }

    /// Frames found and skipped so far.
    pub fn counts(&self) -> ParserCounts {
        self.counts
    }

    /// The problem of the last frame of wrong lengths, once.
    pub fn take_refusal(&mut self) -> Option<Invalid> {
        let (color, depth) = self.refused.take()?;
        let expected = |(low, high): (usize, usize)| {
            if low == high { low.to_string() } else { format!("{low} to {high}") }
        };
        let expected = format!(
            "{} and {}, as the header of the stream has it: start the stream anew with a header of the new size",
            expected(self.limits.color),
            expected(self.limits.depth)
        );
        Some(Invalid::new(
            "length of colour and depth of a frame",
            format!("{color} and {depth}"),
            "bytes",
            expected,
        ))
    }

    /// Bytes held.
    pub fn pending_bytes(&self) -> usize {
        self.bytes.len() - self.start
    }

    fn front(&self) -> Front {
        let bytes = &self.bytes[self.start..];
        let magic = bytes.len().min(FRAME_MAGIC.len());
        if bytes[..magic] != FRAME_MAGIC[..magic] {
            return Front::Foreign;
        }
        let Some(header) = bytes.first_chunk::<FRAME_HEADER_BYTES>() else { return Front::Incomplete };
        let (stamp, color, depth) = fields(header);
        let is_within = |length: usize, (low, high): (usize, usize)| (low..=high).contains(&length);
        if is_within(color, self.limits.color) && is_within(depth, self.limits.depth) {
            Front::Frame(stamp, color, depth)
        } else {
            Front::WrongLengths(color, depth)
        }
    }

    /// Skips to the next byte that can begin a frame.
    fn skip(&mut self) {
        let rest = &self.bytes[self.start + 1..];
        let skipped = 1 + rest.iter().position(|byte| *byte == FRAME_MAGIC[0]).unwrap_or(rest.len());
        self.start += skipped;
        self.counts.skipped_bytes += skipped as u64;
    }
}

/// Stamp and lengths of a frame's header.
fn fields(header: &[u8; FRAME_HEADER_BYTES]) -> (Stamp, usize, usize) {
    let [_, _, _, _, s0, s1, s2, s3, s4, s5, s6, s7, c0, c1, c2, c3, d0, d1, d2, d3] = *header;
    let stamp = Stamp::from_nanos(i64::from_le_bytes([s0, s1, s2, s3, s4, s5, s6, s7]));
    let length = |bytes: [u8; 4]| u32::from_le_bytes(bytes) as usize;
    (stamp, length([c0, c1, c2, c3]), length([d0, d1, d2, d3]))
}
