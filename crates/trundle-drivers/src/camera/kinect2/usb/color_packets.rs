//! JPEG files of colour from bulk transfers.
//!
//! A packet consists of a header (sequence, magic), a JPEG file, up to 3 bytes of padding, filler, and a footer at the end of a transfer.
//! The footer is magic, sequence, length of the filler, two unknown, time, exposure, gain, magic, length of the packet, gamma, three
//! unknown.

use crate::camera::kinect2::packets::TickClock;
use trundle_core::Stamp;

/// Second word of the header. Source: \[Freenect2\].
pub const HEADER_MAGIC: u32 = 0x4242_4242;
/// First word of the footer. Source: \[Freenect2\].
pub const FOOTER_MAGIC: u32 = 0x3939_3939;
/// Bytes of the header. Source: \[Freenect2\].
pub const HEADER_BYTES: usize = 8;
/// Bytes of the footer. Source: \[Freenect2\].
pub const FOOTER_BYTES: usize = 56;
/// Longest packet \[bytes\]: 2 MB. Source: \[Freenect2\].
pub const MAX_PACKET_BYTES: usize = 2 << 20;
/// Maximum number of bytes between the end of the JPEG file and the filler. Source: \[Freenect2\].
const MAX_PADDING_BYTES: usize = 3;
/// First bytes of a JPEG file. Source: ITU-T T.81, B.1.1.3.
const JPEG_START: [u8; 2] = [0xff, 0xd8];
/// Last bytes of a JPEG file. Source: ITU-T T.81, B.1.1.3.
const JPEG_END: [u8; 2] = [0xff, 0xd9];

/// A colour image.
#[derive(Debug, Clone, PartialEq)]
pub struct ColorPacket {
    /// Time of the image on the camera's clock.
    pub stamp: Stamp,
    /// Number of the image.
    pub sequence: u32,
    /// The JPEG file.
    pub jpeg: Vec<u8>,
}

/// Finds colour images in bulk transfers. It stores at most one packet.
#[derive(Debug, Clone, Default)]
pub struct ColorPackets {
    bytes: Vec<u8>,
    last: Option<u32>,
    clock: TickClock,
    skipped: u64,
}

impl ColorPackets {
    /// Adds one transfer; returns the image if this transfer ends its packet. An incomplete or repeated packet is skipped.
    pub fn push(&mut self, transfer: &[u8]) -> Option<ColorPacket> {
        if self.bytes.len() + transfer.len() > MAX_PACKET_BYTES {
            self.skip();
        }
        if transfer.len() > MAX_PACKET_BYTES {
            self.skipped += transfer.len() as u64;
            return None;
        }
        self.bytes.extend_from_slice(transfer);
        let footer = Footer::at_end(&self.bytes)?;
        let image = self.image(&footer);
        if image.is_none() {
            self.skip();
        }
        self.bytes.clear();
        let (stamp, jpeg) = image?;
        self.last = Some(footer.sequence);
        Some(ColorPacket { stamp, sequence: footer.sequence, jpeg })
    }

    /// Reports a lost transfer: its packet is skipped.
    pub fn lose(&mut self) {
        self.skip();
    }

    /// Bytes that belong to no whole packet, or to one that came before.
    pub fn skipped_bytes(&self) -> u64 {
        self.skipped
    }

    fn image(&mut self, footer: &Footer) -> Option<(Stamp, Vec<u8>)> {
        // Bytes of a packet with a lost footer may precede this packet.
        let start = self.bytes.len().checked_sub(footer.packet_bytes)?;
        let packet = &self.bytes[start..];
        let (head, _) = packet.as_chunks::<4>();
        let head = head.first_chunk::<2>()?.map(u32::from_le_bytes);
        if head != [footer.sequence, HEADER_MAGIC] || self.last == Some(footer.sequence) {
            return None;
        }
        let end = packet.len().checked_sub(FOOTER_BYTES)?.checked_sub(footer.filler_bytes)?;
        let jpeg = jpeg_of(packet.get(HEADER_BYTES..end)?)?.to_vec();
        self.skipped += start as u64;
        Some((self.clock.stamp(footer.ticks), jpeg))
    }

    fn skip(&mut self) {
        self.skipped += self.bytes.len() as u64;
        self.bytes.clear();
    }
}

/// The JPEG file at the start of `bytes`, without the padding after it.
fn jpeg_of(bytes: &[u8]) -> Option<&[u8]> {
    let mut ends = (0..=MAX_PADDING_BYTES).filter_map(|padding| bytes.len().checked_sub(padding));
    let end = ends.find(|end| bytes[..*end].ends_with(&JPEG_END))?;
    Some(&bytes[..end]).filter(|jpeg| jpeg.starts_with(&JPEG_START))
}

/// The footer of a packet.
struct Footer {
    sequence: u32,
    filler_bytes: usize,
    ticks: u32,
    packet_bytes: usize,
}

impl Footer {
    fn at_end(bytes: &[u8]) -> Option<Self> {
        let (words, _) = bytes.last_chunk::<FOOTER_BYTES>()?.as_chunks::<4>();
        let words = words.first_chunk::<{ FOOTER_BYTES / 4 }>()?.map(u32::from_le_bytes);
        let is_footer = (words[0], words[8]) == (FOOTER_MAGIC, HEADER_MAGIC);
        is_footer.then_some(Self {
            sequence: words[1],
            filler_bytes: words[2] as usize,
            ticks: words[5],
            packet_bytes: words[9] as usize,
        })
    }
}
