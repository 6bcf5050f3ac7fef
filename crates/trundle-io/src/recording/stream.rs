//! Sequential reader of the messages of any MCAP file, with bounded memory.

use super::chunk_decoder::ChunkDecoder;
use crate::IoError;
use mcap::McapError;
use mcap::records::Record;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// Longest record that is read, bytes: bounds what a broken length can ask for.
const MAX_RECORD: usize = 1 << 28;

/// A message as it stands in the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RawMessage {
    pub topic: String,
    pub schema: String,
    pub stamp: Stamp,
    pub data: Vec<u8>,
}

/// How messages are written that a reader wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Trundle's own: any other message is an error.
    Json,
    /// Those of ROS 2; others are passed over.
    Cdr,
}

/// The messages of an MCAP file in the order of the file; of its chunks a piece is in memory at a time, of compressed ones
/// (lz4, zstd) the whole.
pub(crate) struct MessageStream {
    path: PathBuf,
    file: File,
    reader: LinearReader,
    encoding: Encoding,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (String, u16)>,
    passed_over: BTreeSet<u16>,
    read: u64,
    len: u64,
    stopped: bool,
}

impl MessageStream {
    pub fn open(path: &Path, encoding: Encoding) -> Result<Self, IoError> {
        let system = || IoError::system(path, "read");
        let file = File::open(path).map_err(system())?;
        let meta = file.metadata().map_err(system())?;
        if meta.is_dir() {
            return Err(system()(std::io::ErrorKind::IsADirectory.into()));
        }
        let limit = usize::try_from(meta.len()).unwrap_or(MAX_RECORD).clamp(1024, MAX_RECORD);
        let options =
            LinearReaderOptions::default().with_validate_chunk_crcs(true).with_record_length_limit(limit);
        let mut reader = LinearReader::new_with_options(options);
        for decoder in ChunkDecoder::all() {
            reader.add_decompressor(decoder).expect("invariant: the decoders have names");
        }
        Ok(Self {
            path: path.to_owned(),
            file,
            reader,
            encoding,
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            passed_over: BTreeSet::new(),
            read: 0,
            len: meta.len(),
            stopped: false,
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How much of the file is read, 0 to 1.
    pub fn progress(&self) -> f64 {
        if self.len == 0 { 1.0 } else { (self.read as f64 / self.len as f64).min(1.0) }
    }

    /// Gives no more messages from now on.
    pub fn stop(&mut self) {
        self.stopped = true;
    }

    /// The next message; `None` at the end of a whole file.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        while !self.stopped {
            let Some(event) = self.reader.next_event() else { return Ok(None) };
            match event.map_err(|error| broken(&self.path, self.read, &error))? {
                LinearReadEvent::ReadRequest(need) => {
                    let buffer = self.reader.insert(need.max(1 << 16));
                    let read = self.file.read(buffer).map_err(IoError::system(&self.path, "read"))?;
                    self.reader.notify_read(read);
                    self.read += read as u64;
                }
                LinearReadEvent::Record { opcode, data } => {
                    let record = mcap::parse_record(opcode, data)
                        .map_err(|error| broken(&self.path, self.read, &error))?
                        .into_owned();
                    if let Some(message) = self.take(record)? {
                        return Ok(Some(message));
                    }
                }
            }
        }
        Ok(None)
    }

    /// Remembers schemas and channels, gives messages their names.
    fn take(&mut self, record: Record<'static>) -> Result<Option<RawMessage>, IoError> {
        match record {
            Record::Schema { header, .. } => drop(self.schemas.insert(header.id, header.name)),
            Record::Channel(channel) => {
                let expected = match self.encoding {
                    Encoding::Json => "json",
                    Encoding::Cdr => "cdr",
                };
                if channel.message_encoding != expected && self.encoding == Encoding::Cdr {
                    self.passed_over.insert(channel.id);
                    return Ok(None);
                }
                if channel.message_encoding != expected {
                    let problem = format!(
                        "messages on {} are in '{}', expected {expected}",
                        channel.topic, channel.message_encoding
                    );
                    return Err(IoError::malformed(&self.path, problem));
                }
                self.channels.insert(channel.id, (channel.topic, channel.schema_id));
            }
            Record::Message { header, .. } if self.passed_over.contains(&header.channel_id) => {}
            Record::Message { header, data } => {
                let (topic, schema) = self.channels.get(&header.channel_id).ok_or_else(|| {
                    let problem = format!("a message on the unknown channel {}", header.channel_id);
                    IoError::malformed(&self.path, problem)
                })?;
                let nanos = i64::try_from(header.log_time).map_err(|_| {
                    IoError::malformed(&self.path, format!("log time {} ns is out of range", header.log_time))
                })?;
                return Ok(Some(RawMessage {
                    topic: topic.clone(),
                    schema: self.schemas.get(schema).cloned().unwrap_or_default(),
                    stamp: Stamp::from_nanos(nanos),
                    data: data.into_owned(),
                }));
            }
            _ => {}
        }
        Ok(None)
    }
}

fn broken(path: &Path, read: u64, error: &McapError) -> IoError {
    let problem = match error {
        McapError::BadMagic if read <= 1 << 16 => "not an MCAP recording".to_owned(),
        McapError::UnexpectedEof | McapError::UnexpectedEoc => {
            format!("the recording is truncated: it ends after {read} bytes, in the middle of a record")
        }
        other => format!("the recording is broken before byte {read}: {other}"),
    };
    IoError::malformed(path, problem)
}
