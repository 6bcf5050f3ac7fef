//! Packets out of a stream of bytes that may be cut, lost, doubled, flipped or mixed with others.
//!
//! The decoder searches for the header and checks the sub-payloads on arrival, then the checksum. Only the first byte of a refused frame is
//! skipped: a good packet within the refused bytes is found. The division of the stream into reads has no effect on packets and counters.
//! The buffer contains 259 bytes, one frame. The cost is linear in the bytes for valid packets, and at most 255 steps per byte for garbage.
//!
//! An XOR checksum cannot distinguish a packet that lost a byte 0xAA from a valid one if the next packet's header follows. The last byte of
//! such a packet is the header's first byte. The decoder keeps this byte in its buffer, so the next packet is not lost.

use super::protocol::command::{KobukiCommand, min_command_bytes};
use super::protocol::feedback::{Feedback, min_feedback_bytes};
use super::protocol::frame::{
    FRAME_HEADER, FRAME_OVERHEAD_BYTES, MAX_PAYLOAD_BYTES, MIN_PAYLOAD_BYTES, check_payload, checksum,
};
use serde::Serialize;

/// Bytes of the largest frame. Source: the protocol's one length byte.
const MAX_FRAME_BYTES: usize = MAX_PAYLOAD_BYTES + FRAME_OVERHEAD_BYTES;

/// Counts of bytes that a decoder read and dropped.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct DecoderCounters {
    /// Sound packets.
    pub packets: u64,
    /// Bytes outside of sound packets.
    pub skipped_bytes: u64,
    /// Headers refused for a wrong checksum.
    pub wrong_checksum: u64,
    /// Headers refused for a length below 3, or for sub-payloads that do not fill the packet or are too short.
    pub wrong_length: u64,
    /// Unknown sub-payloads in sound packets.
    pub unknown_payloads: u64,
}

impl DecoderCounters {
    /// Refused headers of either kind.
    pub fn refused(&self) -> u64 {
        self.wrong_checksum + self.wrong_length
    }
}

/// Frames out of a stream of bytes, of one direction of the protocol.
#[derive(Debug, Clone)]
struct FrameDecoder {
    buffer: Vec<u8>,
    min_bytes: fn(u8) -> Option<usize>,
    /// The first byte of the buffer is also the checksum of the packet before.
    is_shared: bool,
    counters: DecoderCounters,
}

/// Kind of the beginning of the buffer.
enum Candidate {
    Incomplete,
    Garbage(usize),
    WrongLength,
    WrongChecksum,
    Frame(usize),
}

impl FrameDecoder {
    fn new(min_bytes: fn(u8) -> Option<usize>) -> Self {
        let buffer = Vec::with_capacity(MAX_FRAME_BYTES);
        Self { buffer, min_bytes, is_shared: false, counters: DecoderCounters::default() }
    }

    /// Calls `on_payload` for every frame that ends in `bytes`.
    fn push(&mut self, mut bytes: &[u8], mut on_payload: impl FnMut(&[u8], &mut DecoderCounters)) {
        while !bytes.is_empty() {
            let room = (MAX_FRAME_BYTES - self.buffer.len()).min(bytes.len());
            self.buffer.extend_from_slice(&bytes[..room]);
            bytes = &bytes[room..];
            self.read_frames(&mut on_payload);
        }
    }

    /// Reads all whole frames of the buffer. Afterwards the buffer is shorter than a frame.
    fn read_frames(&mut self, on_payload: &mut impl FnMut(&[u8], &mut DecoderCounters)) {
        let mut at = 0;
        while at < self.buffer.len() {
            let rest = &self.buffer[at..];
            let skipped = match candidate(rest, self.min_bytes) {
                Candidate::Incomplete => break,
                Candidate::Garbage(bytes) => bytes,
                Candidate::WrongLength => {
                    self.counters.wrong_length += 1;
                    1
                }
                Candidate::WrongChecksum => {
                    self.counters.wrong_checksum += 1;
                    1
                }
                Candidate::Frame(bytes) => {
                    self.counters.packets += 1;
                    on_payload(&rest[3..bytes - 1], &mut self.counters);
                    self.is_shared = rest[bytes - 1] == FRAME_HEADER[0];
                    at += bytes - usize::from(self.is_shared);
                    continue;
                }
            };
            self.counters.skipped_bytes += (skipped - usize::from(self.is_shared)) as u64;
            self.is_shared = false;
            at += skipped;
        }
        self.buffer.drain(..at);
    }

    fn clear(&mut self) {
        self.counters.skipped_bytes += (self.buffer.len() - usize::from(self.is_shared)) as u64;
        self.buffer.clear();
        self.is_shared = false;
    }
}

/// Reads the beginning of bytes that are not empty.
fn candidate(bytes: &[u8], min_bytes: fn(u8) -> Option<usize>) -> Candidate {
    if bytes[0] != FRAME_HEADER[0] {
        let header = bytes.iter().position(|byte| *byte == FRAME_HEADER[0]);
        return Candidate::Garbage(header.unwrap_or(bytes.len()));
    }
    if bytes.get(1).is_some_and(|byte| *byte != FRAME_HEADER[1]) {
        return Candidate::Garbage(1);
    }
    let Some(payload_bytes) = bytes.get(2).map(|byte| usize::from(*byte)) else {
        return Candidate::Incomplete;
    };
    let frame_bytes = payload_bytes + FRAME_OVERHEAD_BYTES;
    let received = &bytes[3..bytes.len().min(frame_bytes - 1)];
    if payload_bytes < MIN_PAYLOAD_BYTES || check_payload(received, payload_bytes, min_bytes).is_err() {
        return Candidate::WrongLength;
    }
    match bytes.get(2..frame_bytes) {
        None => Candidate::Incomplete,
        Some(body) if checksum(body) != 0 => Candidate::WrongChecksum,
        Some(_) => Candidate::Frame(frame_bytes),
    }
}

/// Feedback packets out of the bytes that a base sends.
#[derive(Debug, Clone)]
pub struct FeedbackDecoder(FrameDecoder);

impl Default for FeedbackDecoder {
    fn default() -> Self {
        Self(FrameDecoder::new(min_feedback_bytes))
    }
}

impl FeedbackDecoder {
    /// Calls `on_feedback` for every packet that ends in `bytes`.
    pub fn push(&mut self, bytes: &[u8], mut on_feedback: impl FnMut(Feedback)) {
        self.0.push(bytes, |payload, counters| {
            if let Ok((feedback, unknown)) = Feedback::decode(payload) {
                counters.unknown_payloads += u64::from(unknown);
                on_feedback(feedback);
            }
        });
    }

    /// Bytes read and dropped since the start.
    pub fn counters(&self) -> DecoderCounters {
        self.0.counters
    }

    /// Drops the bytes of an unfinished packet, for a new stream.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// Decodes commands from the bytes sent by a driver. The emulator uses it.
#[derive(Debug, Clone)]
pub struct CommandDecoder(FrameDecoder);

impl Default for CommandDecoder {
    fn default() -> Self {
        Self(FrameDecoder::new(min_command_bytes))
    }
}

impl CommandDecoder {
    /// Calls `on_command` for every command of the packets that end in `bytes`.
    pub fn push(&mut self, bytes: &[u8], mut on_command: impl FnMut(KobukiCommand)) {
        self.0.push(bytes, |payload, _| {
            KobukiCommand::decode(payload).into_iter().flatten().for_each(&mut on_command)
        });
    }

    /// Bytes read and dropped since the start.
    pub fn counters(&self) -> DecoderCounters {
        self.0.counters
    }
}

/// A fuzz target: reads any bytes in one call and byte by byte.
///
/// # Panics
/// When the two readings differ, or when a byte is neither skipped, nor part of a packet, nor buffered.
pub fn fuzz_decoder(bytes: &[u8]) {
    let (mut whole, mut single) = (FeedbackDecoder::default(), FeedbackDecoder::default());
    let (mut packets, mut packets_by_byte) = (Vec::new(), Vec::new());
    whole.push(bytes, |feedback| packets.push(feedback));
    bytes.chunks(1).for_each(|byte| single.push(byte, |feedback| packets_by_byte.push(feedback)));
    assert_eq!(packets, packets_by_byte, "packets depend on how the stream is cut");
    assert_eq!(whole.counters(), single.counters(), "counters depend on how the stream is cut");
    assert!(whole.0.buffer.len() < MAX_FRAME_BYTES, "the buffer holds a whole frame");
    CommandDecoder::default().push(bytes, drop);
}

#[cfg(test)]
mod tests;
