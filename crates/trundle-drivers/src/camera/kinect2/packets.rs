//! Frames put together from USB sub-packets.
//!
//! A frame comes as ten sub-packets, one packed image each. A footer follows each: time, number of the frame (sequence), number of the
//! image (subsequence), and length. The fields are published in the messages of open drivers. Their order and size here are an assumption:
//! 152 bytes, little endian u32: 0, 9, time, sequence, subsequence, length, and 32 further fields.

use super::layout::{IMAGE_BYTES, IMAGE_COUNT};
use trundle_core::Stamp;

/// Bytes of the footer. Source: assumed; it agrees with \[Freenect2\].
pub const FOOTER_BYTES: usize = 152;
/// First two fields of the footer. Source: assumed; it agrees with \[Freenect2\].
const FOOTER_MAGIC: [u32; 2] = [0, 9];
/// Nanoseconds in one step of the time \[ns\]: 0.125 ms. Source: assumed.
const TICK_NANOS: i64 = 125_000;

/// A packed image of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SubPacket {
    /// Time of the frame \[0.125 ms\].
    pub ticks: u32,
    /// Number of the frame.
    pub sequence: u32,
    /// Number of the image in the frame, 0 to 9.
    pub subsequence: u32,
    /// The packed image.
    pub bytes: Vec<u8>,
}

/// All packed images of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedFrame {
    /// Time of the frame on the camera's clock.
    pub stamp: Stamp,
    /// Number of the frame.
    pub sequence: u32,
    /// The images in their order.
    pub images: [Vec<u8>; IMAGE_COUNT],
}

/// Extracts sub-packets from USB transfers. It stores at most one sub-packet.
#[derive(Debug, Clone, Default)]
pub struct SubPacketParser {
    bytes: Vec<u8>,
    skipped: u64,
}

impl SubPacketParser {
    /// Adds the bytes of one USB transfer; returns the sub-packet if this transfer ends with its footer. A sub-packet of wrong length is
    /// skipped.
    pub fn push(&mut self, transfer: &[u8]) -> Option<SubPacket> {
        if self.bytes.len() + transfer.len() > IMAGE_BYTES + FOOTER_BYTES {
            self.skip();
        }
        self.bytes.extend_from_slice(transfer);
        let length = self.bytes.len().checked_sub(FOOTER_BYTES)?;
        let [_, _, ticks, sequence, subsequence, stated] = footer(&self.bytes[length..])?;
        if stated as usize != length || length != IMAGE_BYTES || subsequence as usize >= IMAGE_COUNT {
            self.skip();
            return None;
        }
        self.bytes.truncate(length);
        Some(SubPacket { ticks, sequence, subsequence, bytes: std::mem::take(&mut self.bytes) })
    }

    /// Bytes that belong to no whole sub-packet.
    pub fn skipped_bytes(&self) -> u64 {
        self.skipped
    }

    /// Skips the bytes of a sub-packet that is not whole.
    pub(in crate::camera::kinect2) fn skip(&mut self) {
        self.skipped += self.bytes.len() as u64;
        self.bytes.clear();
    }
}

/// The known fields of a footer.
fn footer(bytes: &[u8]) -> Option<[u32; 6]> {
    let (words, _) = bytes.as_chunks::<4>();
    let fields = words.first_chunk::<6>()?.map(u32::from_le_bytes);
    (fields[..2] == FOOTER_MAGIC).then_some(fields)
}

/// Puts frames together from sub-packets.
#[derive(Debug, Clone, Default)]
pub struct FrameAssembler {
    sequence: Option<u32>,
    ticks: u32,
    images: [Vec<u8>; IMAGE_COUNT],
    dropped: u64,
    /// The frame that was whole last.
    finished: Option<u32>,
    repeated: u64,
    clock: TickClock,
}

impl FrameAssembler {
    /// Adds a sub-packet; returns the frame if the sub-packet completes it. A new sequence drops an incomplete frame. Repeated sub-packets
    /// of the last complete frame are skipped.
    pub fn push(&mut self, packet: SubPacket) -> Option<PackedFrame> {
        if self.finished == Some(packet.sequence) {
            self.repeated += 1;
            return None;
        }
        if self.sequence != Some(packet.sequence) {
            self.begin(&packet);
        }
        let is_whole = packet.bytes.len() == IMAGE_BYTES;
        if let Some(image) = self.images.get_mut(packet.subsequence as usize).filter(|_| is_whole) {
            *image = packet.bytes;
        }
        if self.images.iter().any(Vec::is_empty) {
            return None;
        }
        let sequence = self.sequence.take()?;
        self.finished = Some(sequence);
        let stamp = self.clock.stamp(self.ticks);
        Some(PackedFrame { stamp, sequence, images: std::mem::take(&mut self.images) })
    }

    /// Frames dropped since a sub-packet was missing.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Number of sub-packets skipped because their frame was complete.
    pub fn repeated(&self) -> u64 {
        self.repeated
    }

    fn begin(&mut self, packet: &SubPacket) {
        self.dropped += self.images.iter().any(|image| !image.is_empty()) as u64;
        self.images.iter_mut().for_each(Vec::clear);
        (self.sequence, self.ticks) = (Some(packet.sequence), packet.ticks);
    }
}

/// A clock of 32 bits that continues after its overflow every 6.2 days.
#[derive(Debug, Clone, Default)]
pub struct TickClock {
    /// Last time including overflows \[0.125 ms\].
    long_ticks: Option<i64>,
}

impl TickClock {
    /// The time of a number of ticks, less than half a period from the previous one.
    pub fn stamp(&mut self, ticks: u32) -> Stamp {
        let last = self.long_ticks.unwrap_or(ticks.into());
        let step = ticks.wrapping_sub(last as u32).cast_signed();
        let ticks = last.saturating_add(step.into());
        self.long_ticks = Some(ticks);
        Stamp::from_nanos(ticks.saturating_mul(TICK_NANOS))
    }
}
