//! Writer of the MCAP container of a recording: chunks, their indexes, the summary. Source: the MCAP specification.

mod chunk;
mod record;

pub(super) use chunk::Group;

use chunk::{Chunk, ChunkPlace};
use mcap::records::op;
use record::RecordWriter;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// Size at which the open chunks are written \[bytes\]. A killed program loses the content of open chunks. The index stores the positions
/// of all chunks: some 20 MB for an hour of 30 images per second. Source: ours.
const FLUSH_BYTES: usize = 1 << 20;

/// Writes messages into three open chunks, one per [`Group`], each with the compression that suits its content.
pub(super) struct Container<W: Write> {
    writer: W,
    /// Bytes written so far.
    at: u64,
    schemas: Vec<Vec<u8>>,
    channels: Vec<ChannelEntry>,
    open: [Chunk; Group::ALL.len()],
    places: Vec<ChunkPlace>,
}

struct ChannelEntry {
    /// The record's content.
    record: Vec<u8>,
    schema: u16,
    group: Group,
    messages: u64,
}

impl<W: Write> Container<W> {
    pub(super) fn new(mut writer: W, profile: &str, library: &str) -> io::Result<Self> {
        let header = RecordWriter::default().text(profile).text(library).record(op::HEADER);
        writer.write_all(mcap::MAGIC)?;
        writer.write_all(&header)?;
        let at = (mcap::MAGIC.len() + header.len()) as u64;
        let open = Group::ALL.map(|_| Chunk::default());
        Ok(Self { writer, at, schemas: Vec::new(), channels: Vec::new(), open, places: Vec::new() })
    }

    /// A schema of the definition `text`; its number.
    pub(super) fn add_schema(&mut self, name: &str, encoding: &str, text: &str) -> u16 {
        let id = self.schemas.len() as u16 + 1;
        let record = RecordWriter::default().u16(id).text(name).text(encoding).text(text);
        self.schemas.push(record.content());
        id
    }

    /// A channel of CDR messages of a schema; its number.
    pub(super) fn add_channel(
        &mut self,
        topic: &str,
        schema: u16,
        metadata: &BTreeMap<String, String>,
        group: Group,
    ) -> u16 {
        let id = self.channels.len() as u16;
        let pairs =
            metadata.iter().fold(RecordWriter::default(), |pairs, (key, value)| pairs.text(key).text(value));
        let record =
            RecordWriter::default().u16(id).u16(schema).text(topic).text("cdr").bytes(&pairs.content());
        self.channels.push(ChannelEntry { record: record.content(), schema, group, messages: 0 });
        id
    }

    /// Adds a message of a channel that was added before; `time` in nanoseconds.
    pub(super) fn write_message(&mut self, channel: u16, time: u64, data: &[u8]) -> io::Result<()> {
        let entry = &mut self.channels[usize::from(channel)];
        let chunk = &mut self.open[entry.group as usize];
        if entry.messages == 0 {
            chunk.push_record(op::SCHEMA, &self.schemas[usize::from(entry.schema) - 1]);
            chunk.push_record(op::CHANNEL, &entry.record);
        }
        entry.messages += 1;
        chunk.push_message(channel, entry.messages as u32, time, data);
        let is_full = self.open.iter().map(Chunk::len).sum::<usize>() >= FLUSH_BYTES;
        // The first message is the configuration; a truncated file is useless without it.
        let is_first = self.places.is_empty() && !self.open[Group::Rest as usize].is_empty();
        if is_full || is_first { self.flush_chunks() } else { Ok(()) }
    }

    /// Writes the open chunks, the chunk of other messages last: its messages give the positions of the images.
    fn flush_chunks(&mut self) -> io::Result<()> {
        for group in Group::ALL {
            let chunk = std::mem::take(&mut self.open[group as usize]);
            if chunk.is_empty() {
                continue;
            }
            let (bytes, place) = chunk.packed(group, self.at);
            self.write(&bytes)?;
            self.places.push(place);
        }
        Ok(())
    }

    /// Writes the rest and the index; returns the writer.
    pub(super) fn finish(mut self) -> io::Result<W> {
        self.flush_chunks()?;
        let end = RecordWriter::default().u32(0).record(op::DATA_END);
        self.write(&end)?;
        let summary_start = self.at;
        let groups = self.summary();
        let mut offsets = RecordWriter::default();
        for (opcode, records) in groups.iter().filter(|(_, records)| !records.is_empty()) {
            let offset = RecordWriter::default().u8(*opcode).u64(self.at).u64(records.len() as u64);
            offsets = offsets.append(&offset.record(op::SUMMARY_OFFSET));
            self.write(records)?;
        }
        let offset_start = self.at;
        self.write(&offsets.content())?;
        let footer = RecordWriter::default().u64(summary_start).u64(offset_start).u32(0).record(op::FOOTER);
        self.write(&footer)?;
        self.write(mcap::MAGIC)?;
        self.writer.flush()?;
        Ok(self.writer)
    }

    /// The records of the summary, with their opcodes.
    fn summary(&self) -> [(u8, Vec<u8>); 4] {
        let used = |id: usize| self.channels.iter().any(|channel| usize::from(channel.schema) == id + 1);
        let schemas = self.schemas.iter().enumerate().filter(|(id, _)| used(*id));
        let schemas =
            schemas.fold(RecordWriter::default(), |all, (_, schema)| all.append_record(op::SCHEMA, schema));
        let channels = self.channels.iter();
        let channels = channels
            .fold(RecordWriter::default(), |all, entry| all.append_record(op::CHANNEL, &entry.record));
        let places = self.places.iter();
        let places = places.fold(RecordWriter::default(), |all, place| {
            all.append_record(op::CHUNK_INDEX, &place.index_record())
        });
        [
            (op::SCHEMA, schemas.content()),
            (op::CHANNEL, channels.content()),
            (op::STATISTICS, self.statistics()),
            (op::CHUNK_INDEX, places.content()),
        ]
    }

    fn statistics(&self) -> Vec<u8> {
        let counts = self.channels.iter().enumerate();
        let counts = counts
            .fold(RecordWriter::default(), |all, (id, channel)| all.u16(id as u16).u64(channel.messages));
        let first = self.places.iter().map(|place| place.first).min().unwrap_or(0);
        let last = self.places.iter().map(|place| place.last).max().unwrap_or(0);
        let messages = self.channels.iter().map(|channel| channel.messages).sum();
        RecordWriter::default()
            .u64(messages)
            .u16(self.schemas.len() as u16)
            .u32(self.channels.len() as u32)
            .u32(0)
            .u32(0)
            .u32(self.places.len() as u32)
            .u64(first)
            .u64(last)
            .bytes(&counts.content())
            .record(op::STATISTICS)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.at += bytes.len() as u64;
        self.writer.write_all(bytes)
    }
}
