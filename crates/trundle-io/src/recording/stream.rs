//! Sequential reader of the messages of any MCAP file, with bounded memory.

use super::chunk_decoder::{OwnedRecord, records_of_chunk};
use super::cut::{WHOLE, records_of_cut_chunk, whole_part};
use super::record_parser::parse_needed_record;
use super::topics;
use super::unpacked::unpacked;
use crate::IoError;
use mcap::McapError;
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// Longest record that is read, bytes: a bound for broken lengths. Source: ours.
const MAX_RECORD: usize = 1 << 28;

/// Largest ratio of a record to its packed file. A bound for broken lengths. Source: ours.
const MAX_PACKING: u64 = 256;

/// A message with the bytes of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RawMessage {
    pub topic: String,
    pub schema: String,
    pub stamp: Stamp,
    /// Whether the data is JSON, not CDR.
    pub is_json: bool,
    pub data: Vec<u8>,
}

/// Encoding of the messages that a reader accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Trundle's own: JSON, or CDR of ROS 2; any other message is an error.
    Own,
    /// Messages of ROS 2; others are skipped.
    Cdr,
}

/// The messages of an MCAP file in the order of the file; one chunk is in memory.
pub(crate) struct MessageStream {
    path: PathBuf,
    file: Box<dyn Read + Send>,
    is_packed: bool,
    reader: LinearReader,
    /// Position of the cut, once reading has reached it.
    cut: Option<RecordingCut>,
    /// Records of one chunk that are read but not yet delivered.
    records: VecDeque<OwnedRecord>,
    /// Records of the chunk that the file was cut in.
    last_records: VecDeque<OwnedRecord>,
    encoding: Encoding,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, ChannelName>,
    passed_over: BTreeSet<u16>,
    read: u64,
    len: u64,
    stopped: bool,
}

/// Topic and schema of a channel.
struct ChannelName {
    topic: String,
    schema: u16,
    is_json: bool,
    /// Schema of the JSON in the channel's texts.
    json_schema: Option<String>,
}

/// Position at which a recording was cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordingCut {
    /// Length of the file \[bytes\].
    pub byte: u64,
}

impl RecordingCut {
    /// The cut in one sentence; `seconds`: duration of the data before the cut.
    #[must_use]
    pub fn report(&self, seconds: f64) -> String {
        format!("the recording was cut at byte {}; {seconds:.2} s of it were read", self.byte)
    }
}

impl MessageStream {
    /// The messages of a complete file; a cut file gives an error at the cut.
    pub fn open(path: &Path, encoding: Encoding) -> Result<Self, IoError> {
        Self::open_file(path, encoding, false)
    }

    /// The messages of a file, of a cut one those before the cut.
    pub fn open_to_cut(path: &Path, encoding: Encoding) -> Result<Self, IoError> {
        Self::open_file(path, encoding, true)
    }

    fn open_file(path: &Path, encoding: Encoding, to_cut: bool) -> Result<Self, IoError> {
        let system = || IoError::system(path, "read");
        let mut file = File::open(path).map_err(system())?;
        let meta = file.metadata().map_err(system())?;
        if meta.is_dir() {
            return Err(system()(std::io::ErrorKind::IsADirectory.into()));
        }
        let part = if to_cut { whole_part(&mut file, meta.len()).map_err(system())? } else { WHOLE };
        let last_records = match part.is_cut {
            true => records_of_cut_chunk(&mut file, part.end).map_err(system())?,
            false => Vec::new(),
        };
        let (file, is_packed) = unpacked(file).map_err(system())?;
        let bytes = meta.len().saturating_mul(if is_packed { MAX_PACKING } else { 1 });
        let limit = usize::try_from(bytes).unwrap_or(MAX_RECORD).clamp(1024, MAX_RECORD);
        let options = LinearReaderOptions::default()
            .with_emit_chunks(true)
            .with_record_length_limit(limit)
            .with_skip_end_magic(part.is_cut);
        let reader = LinearReader::new_with_options(options);
        Ok(Self {
            path: path.to_owned(),
            file: Box::new(file.take(part.end)),
            is_packed,
            reader,
            cut: part.is_cut.then_some(RecordingCut { byte: meta.len() }),
            records: VecDeque::new(),
            last_records: last_records.into(),
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

    /// Position of the cut, once reading has reached it.
    pub fn cut(&self) -> Option<RecordingCut> {
        self.cut
    }

    /// Share of the file that is read, 0 to 1.
    pub fn progress(&self) -> f64 {
        if self.len == 0 { 1.0 } else { (self.read as f64 / self.len as f64).min(1.0) }
    }

    /// Ends the stream: no further messages follow.
    pub fn stop(&mut self) {
        self.stopped = true;
    }

    /// The next message; `None` at the end of a whole file.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        while !self.stopped {
            while let Some((opcode, data)) = self.records.pop_front() {
                if let Some(message) = self.parse(opcode, &data)? {
                    return Ok(Some(message));
                }
            }
            if !self.read_records()? {
                return Ok(None);
            }
        }
        Ok(None)
    }

    /// Reads the next record; for a chunk, all its records. Returns whether a record was read.
    fn read_records(&mut self) -> Result<bool, IoError> {
        loop {
            let Some(event) = self.reader.next_event() else {
                std::mem::swap(&mut self.records, &mut self.last_records);
                return Ok(!self.records.is_empty());
            };
            let event = event.map_err(|error| broken((&self.path, self.encoding), self.read, &error))?;
            match event {
                LinearReadEvent::ReadRequest(need) => {
                    let buffer = self.reader.insert(need.max(1 << 16));
                    let read = self.file.read(buffer).map_err(|error| self.refused(error))?;
                    self.reader.notify_read(read);
                    self.read += read as u64;
                }
                LinearReadEvent::Record { opcode: op::CHUNK, data } => {
                    let records = records_of_chunk(data)
                        .map_err(|error| broken((&self.path, self.encoding), self.read, &error))?;
                    self.records.extend(records);
                    return Ok(true);
                }
                LinearReadEvent::Record { opcode, data } => {
                    self.records.push_back((opcode, data.to_vec()));
                    return Ok(true);
                }
            }
        }
    }

    /// The message of a record; `None` of another record.
    fn parse(&mut self, opcode: u8, data: &[u8]) -> Result<Option<RawMessage>, IoError> {
        let record = parse_needed_record(opcode, data)
            .map_err(|error| broken((&self.path, self.encoding), self.read, &error))?
            .map(Record::into_owned);
        record.map_or(Ok(None), |record| self.take(record))
    }

    /// The error of reading on; of a packed file the data is at fault.
    fn refused(&self, error: std::io::Error) -> IoError {
        if !self.is_packed {
            return IoError::system(&self.path, "read")(error);
        }
        let problem = format!("the zstd data is truncated or broken after {} bytes", self.read);
        IoError::malformed(&self.path, problem)
    }

    /// Stores schemas and channels, and assigns their names to messages.
    fn take(&mut self, record: Record<'static>) -> Result<Option<RawMessage>, IoError> {
        match record {
            Record::Schema { header, .. } => drop(self.schemas.insert(header.id, header.name)),
            Record::Channel(channel) => {
                let is_cdr = channel.message_encoding == "cdr";
                if self.encoding == Encoding::Cdr && !is_cdr {
                    self.passed_over.insert(channel.id);
                    return Ok(None);
                }
                if !is_cdr && channel.message_encoding != "json" {
                    let problem = format!(
                        "messages on {} are in '{}', expected json or cdr",
                        channel.topic, channel.message_encoding
                    );
                    return Err(IoError::malformed(&self.path, problem));
                }
                let json_schema = channel.metadata.get(topics::SCHEMA_KEY).cloned();
                let name = ChannelName {
                    topic: channel.topic,
                    schema: channel.schema_id,
                    is_json: !is_cdr,
                    json_schema,
                };
                self.channels.insert(channel.id, name);
            }
            Record::Message { header, .. } if self.passed_over.contains(&header.channel_id) => {}
            Record::Message { header, data } => {
                let ChannelName { topic, schema, is_json, json_schema } =
                    self.channels.get(&header.channel_id).ok_or_else(|| {
                        let problem = format!("a message on the unknown channel {}", header.channel_id);
                        IoError::malformed(&self.path, problem)
                    })?;
                let nanos = i64::try_from(header.log_time).map_err(|_| {
                    IoError::malformed(&self.path, format!("log time {} ns is out of range", header.log_time))
                })?;
                return Ok(Some(RawMessage {
                    topic: topic.clone(),
                    schema: json_schema.as_ref().or(self.schemas.get(schema)).cloned().unwrap_or_default(),
                    stamp: Stamp::from_nanos(nanos),
                    is_json: *is_json,
                    data: data.into_owned(),
                }));
            }
            _ => {}
        }
        Ok(None)
    }
}

fn broken((path, encoding): (&Path, Encoding), read: u64, error: &McapError) -> IoError {
    let hint = if encoding == Encoding::Own { "; --recover reads it to there" } else { "" };
    let problem = match error {
        McapError::BadMagic if read <= 1 << 16 => "not an MCAP recording".to_owned(),
        // A chunk that is longer than the file, within what chunks have.
        McapError::RecordTooLarge { opcode: op::CHUNK, len } if *len <= MAX_RECORD as u64 => {
            format!("the recording is truncated: it ends in the middle of a chunk of {len} bytes{hint}")
        }
        McapError::UnexpectedEof | McapError::UnexpectedEoc => {
            format!("the recording is truncated: it ends after {read} bytes, in the middle of a record{hint}")
        }
        McapError::RecordTooLarge { len, .. } => {
            format!(
                "the recording is broken before byte {read}: a length of {len} bytes is longer than its record or the file"
            )
        }
        other => format!("the recording is broken before byte {read}: {other}"),
    };
    IoError::malformed(path, problem)
}
