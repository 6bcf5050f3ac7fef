//! Frames of depth from isochronous packets.
//!
//! A packed image and its footer fill nine packets of at most 33,792 bytes; an empty packet separates images. A lost packet costs its
//! frame.

use crate::camera::kinect2::packets::{FrameAssembler, PackedFrame, SubPacketParser};

/// Minimum size of the isochronous packets \[bytes\]. Source: \[Freenect2\].
pub const MIN_PACKET_BYTES: usize = 0x8400;

/// Assembles frames from isochronous packets. It stores at most one frame.
#[derive(Debug, Clone, Default)]
pub struct DepthPackets {
    parser: SubPacketParser,
    assembler: FrameAssembler,
}

impl DepthPackets {
    /// Adds one isochronous packet; returns the frame if this packet ends the last of its ten images.
    pub fn push(&mut self, packet: &[u8]) -> Option<PackedFrame> {
        if packet.is_empty() {
            self.parser.skip();
            return None;
        }
        self.assembler.push(self.parser.push(packet)?)
    }

    /// Reports a lost packet: its image is skipped, and its frame is dropped.
    pub fn lose(&mut self) {
        self.parser.skip();
    }

    /// Bytes that belong to no whole image.
    pub fn skipped_bytes(&self) -> u64 {
        self.parser.skipped_bytes()
    }

    /// Frames dropped since an image was missing.
    pub fn dropped(&self) -> u64 {
        self.assembler.dropped()
    }

    /// Number of images skipped because their frame was complete.
    pub fn repeated(&self) -> u64 {
        self.assembler.repeated()
    }
}
