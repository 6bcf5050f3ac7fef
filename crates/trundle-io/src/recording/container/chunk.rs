//! A chunk of messages: collected, packed, indexed.

use super::record::RecordWriter;
use mcap::records::op;
use std::collections::BTreeMap;

/// Messages that are packed together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::recording) enum Group {
    /// Depth images: zstd, apart from others, whose bytes have other frequencies.
    Depth,
    /// Colour images, already compressed: stored unchanged.
    Color,
    /// The rest, in the order of the run: zstd.
    Rest,
}

impl Group {
    /// All groups, in the order of the file.
    pub(super) const ALL: [Self; 3] = [Self::Depth, Self::Color, Self::Rest];
}

/// Level of zstd. Higher levels have no advantage for depth images in RVL. Source: docs/experiments/recording-size.md.
const ZSTD_LEVEL: i32 = 1;

/// A chunk that is being filled.
#[derive(Default)]
pub(super) struct Chunk {
    records: Vec<u8>,
    /// Time and offset of the messages of each channel.
    index: BTreeMap<u16, Vec<(u64, u64)>>,
}

/// Position of a chunk in the file, for the index at the end.
pub(super) struct ChunkPlace {
    pub(super) first: u64,
    pub(super) last: u64,
    start: u64,
    length: u64,
    /// Position of each channel's index.
    index_offsets: BTreeMap<u16, u64>,
    index_length: u64,
    compression: &'static str,
    packed: u64,
    unpacked: u64,
}

impl Chunk {
    pub(super) fn len(&self) -> usize {
        self.records.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    pub(super) fn push_record(&mut self, opcode: u8, content: &[u8]) {
        self.records.push(opcode);
        self.records.extend((content.len() as u64).to_le_bytes());
        self.records.extend(content);
    }

    pub(super) fn push_message(&mut self, channel: u16, sequence: u32, time: u64, data: &[u8]) {
        self.index.entry(channel).or_default().push((time, self.records.len() as u64));
        let head = RecordWriter::default().u16(channel).u32(sequence).u64(time).u64(time).content();
        self.records.push(op::MESSAGE);
        self.records.extend(((head.len() + data.len()) as u64).to_le_bytes());
        self.records.extend(head);
        self.records.extend(data);
    }

    /// The chunk and the index of its messages, for a start at byte `start` of the file.
    pub(super) fn packed(self, group: Group, start: u64) -> (Vec<u8>, ChunkPlace) {
        let times = || self.index.values().flatten().map(|(time, _)| *time);
        let (first, last) = (times().min().unwrap_or(0), times().max().unwrap_or(0));
        let unpacked = self.records.len() as u64;
        let crc = crc32fast::hash(&self.records);
        let (compression, data) = pack(self.records, group);
        let packed = data.len() as u64;
        let head = RecordWriter::default().u64(first).u64(last).u64(unpacked).u32(crc).text(compression);
        let mut bytes = head.u64(packed).append(&data).record(op::CHUNK);
        let length = bytes.len() as u64;
        let mut index_offsets = BTreeMap::new();
        for (channel, messages) in &self.index {
            index_offsets.insert(*channel, start + bytes.len() as u64);
            let entries = messages.iter();
            let entries =
                entries.fold(RecordWriter::default(), |all, (time, offset)| all.u64(*time).u64(*offset));
            let index = RecordWriter::default().u16(*channel).bytes(&entries.content());
            bytes.extend(index.record(op::MESSAGE_INDEX));
        }
        let index_length = bytes.len() as u64 - length;
        let place = ChunkPlace {
            first,
            last,
            start,
            length,
            index_offsets,
            index_length,
            compression,
            packed,
            unpacked,
        };
        (bytes, place)
    }
}

/// The records of a chunk, compressed if that makes them smaller.
fn pack(records: Vec<u8>, group: Group) -> (&'static str, Vec<u8>) {
    if group == Group::Color {
        return ("", records);
    }
    match zrip_encode::compress(&records, ZSTD_LEVEL) {
        Ok(packed) if packed.len() < records.len() => ("zstd", packed),
        _ => ("", records),
    }
}

impl ChunkPlace {
    /// Content of the chunk's record in the summary.
    pub(super) fn index_record(&self) -> Vec<u8> {
        let offsets = self.index_offsets.iter();
        let offsets =
            offsets.fold(RecordWriter::default(), |all, (channel, offset)| all.u16(*channel).u64(*offset));
        RecordWriter::default()
            .u64(self.first)
            .u64(self.last)
            .u64(self.start)
            .u64(self.length)
            .bytes(&offsets.content())
            .u64(self.index_length)
            .text(self.compression)
            .u64(self.packed)
            .u64(self.unpacked)
            .content()
    }
}
