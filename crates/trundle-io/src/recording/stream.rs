//! Sequential reader of the messages of any MCAP file, with bounded memory.

use super::channels::{Channels, Encoding, RawMessage};
use super::chunk_decoder::{HEAD_BYTES, OwnedRecord, records_of_chunk};
use super::cut::{MAGIC_BYTES, RecordingCut, WHOLE, records_of_cut_chunk, whole_part};
use super::damage::{ChunkStarts, Damage, SkippedParts, Summary, broken};
use super::record_parser::{MAX_RECORD, parse_needed_record};
use super::unpacked::unpacked;
use crate::IoError;
use mcap::McapError;
use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Largest ratio of a record to its packed file. A bound for broken lengths. Source: ours.
const MAX_PACKING: u64 = 256;

/// The messages of an MCAP file in the order of the file; one chunk is in memory.
pub(crate) struct MessageStream {
    path: PathBuf,
    file: Box<dyn Read + Send>,
    is_packed: bool,
    reader: LinearReader,
    /// Longest record that is read \[bytes\].
    max_record: usize,
    /// Position of the next record outside of chunks \[bytes of the unpacked file\].
    at: u64,
    /// Whether a cut or damaged file is read as far as possible.
    recovers: bool,
    /// Position of the cut, once reading has reached it.
    cut: Option<RecordingCut>,
    skipped: Option<SkippedParts>,
    /// Starts of the chunks by the summary, once damage was met \[bytes\].
    chunks: Option<ChunkStarts>,
    /// Records of one chunk that are read but not yet delivered, and the position of the chunk.
    records: VecDeque<OwnedRecord>,
    records_at: u64,
    /// Records of the chunk that the file was cut in.
    last_records: VecDeque<OwnedRecord>,
    channels: Channels,
    progress: Progress,
}

/// Bytes of the file.
struct Progress {
    read: u64,
    len: u64,
    is_stopped: bool,
}

impl MessageStream {
    /// The messages of a complete file; a cut or damaged file gives an error at that position.
    pub fn open(path: &Path, encoding: Encoding) -> Result<Self, IoError> {
        Self::open_file(path, encoding, false)
    }

    /// The messages of a cut or damaged file: of a recording of our own, those before that position; of a bag, all that can be read.
    pub fn open_to_cut(path: &Path, encoding: Encoding) -> Result<Self, IoError> {
        Self::open_file(path, encoding, true)
    }

    fn open_file(path: &Path, encoding: Encoding, recovers: bool) -> Result<Self, IoError> {
        let system = || IoError::system(path, "read");
        let mut file = File::open(path).map_err(system())?;
        let meta = file.metadata().map_err(system())?;
        if meta.is_dir() {
            return Err(system()(std::io::ErrorKind::IsADirectory.into()));
        }
        let part = if recovers { whole_part(&mut file, meta.len()).map_err(system())? } else { WHOLE };
        let last_records = match part.is_cut {
            true => records_of_cut_chunk(&mut file, part.end).map_err(system())?,
            false => Vec::new(),
        };
        let (file, is_packed) = unpacked(file).map_err(system())?;
        let bytes = meta.len().saturating_mul(if is_packed { MAX_PACKING } else { 1 });
        let max_record = usize::try_from(bytes).unwrap_or(MAX_RECORD).clamp(1024, MAX_RECORD);
        let options = options(max_record).with_skip_end_magic(part.is_cut);
        Ok(Self {
            path: path.to_owned(),
            file: Box::new(file.take(part.end)),
            is_packed,
            reader: LinearReader::new_with_options(options),
            max_record,
            at: MAGIC_BYTES,
            recovers,
            cut: part.is_cut.then_some(RecordingCut { byte: meta.len(), is_damage: false }),
            skipped: None,
            chunks: None,
            records: VecDeque::new(),
            records_at: MAGIC_BYTES,
            last_records: last_records.into(),
            channels: Channels::new(encoding),
            progress: Progress { read: 0, len: meta.len(), is_stopped: false },
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Position of the cut, once reading has reached it.
    pub fn cut(&self) -> Option<RecordingCut> {
        self.cut
    }

    /// Damaged parts that were left out so far.
    pub fn skipped(&self) -> Option<SkippedParts> {
        self.skipped
    }

    /// Share of the file that is read, 0 to 1.
    pub fn progress(&self) -> f64 {
        let Progress { read, len, .. } = self.progress;
        if len == 0 { 1.0 } else { (read as f64 / len as f64).min(1.0) }
    }

    /// Ends the stream: no further messages follow.
    pub fn stop(&mut self) {
        self.progress.is_stopped = true;
    }

    /// The next message; `None` at the end of a whole file.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        while !self.progress.is_stopped {
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

    /// Reads the next record; for a chunk, all its records. Returns whether the file goes on.
    fn read_records(&mut self) -> Result<bool, IoError> {
        loop {
            let Some(event) = self.reader.next_event() else {
                std::mem::swap(&mut self.records, &mut self.last_records);
                return Ok(!self.records.is_empty());
            };
            self.records_at = self.at;
            let records = match event {
                Ok(LinearReadEvent::ReadRequest(need)) => {
                    self.fill(need)?;
                    continue;
                }
                Ok(LinearReadEvent::Record { opcode, data }) => {
                    self.at += (HEAD_BYTES + data.len()) as u64;
                    if opcode == op::CHUNK {
                        records_of_chunk(data)
                    } else {
                        Ok(vec![(opcode, data.to_vec())])
                    }
                }
                Err(error) => return self.pass(Damage::Length, &error),
            };
            match records {
                Ok(records) => self.records.extend(records),
                Err(error) => return self.pass(Damage::Chunk, &error),
            }
            return Ok(true);
        }
    }

    /// Reads at least `need` bytes if the file has them.
    fn fill(&mut self, need: usize) -> Result<(), IoError> {
        let buffer = self.reader.insert(need.max(1 << 16));
        match self.file.read(buffer) {
            Ok(read) => {
                self.reader.notify_read(read);
                self.progress.read += read as u64;
                Ok(())
            }
            Err(error) if self.is_packed => {
                let problem = format!(
                    "the zstd data is truncated or broken after {} bytes ({error})",
                    self.progress.read
                );
                Err(IoError::malformed(&self.path, problem))
            }
            Err(error) => Err(IoError::system(&self.path, "read")(error)),
        }
    }

    /// The message of a record; `None` for another record.
    fn parse(&mut self, opcode: u8, data: &[u8]) -> Result<Option<RawMessage>, IoError> {
        match parse_needed_record(opcode, data) {
            Ok(Some(record)) => self.channels.take(record.into_owned(), &self.path),
            Ok(None) => Ok(None),
            Err(error) => {
                self.records.clear();
                self.pass(Damage::Chunk, &error).map(|_| None)
            }
        }
    }

    /// Passes a damaged part at `records_at`, if the file is read as far as possible. Returns whether the file goes on.
    fn pass(&mut self, damage: Damage, error: &McapError) -> Result<bool, IoError> {
        let encoding = self.channels.encoding();
        let is_other_kind = matches!(error, McapError::BadMagic) && self.at == MAGIC_BYTES;
        if is_other_kind || !self.recovers || matches!(error, McapError::UnsupportedCompression(_)) {
            return Err(broken(&self.path, encoding, self.records_at, error));
        }
        let mut named = Vec::new();
        if self.chunks.is_none() {
            let summary = match self.is_packed {
                true => Summary::default(),
                false => Summary::read(&self.path).map_err(IoError::system(&self.path, "read"))?,
            };
            // Only once: a damaged definition would be met again and again.
            (self.chunks, named) = (Some(summary.chunks), summary.named);
        }
        let next = match damage {
            Damage::Chunk => Some(self.at),
            Damage::Length => self.chunks.as_ref().and_then(|chunks| chunks.behind(self.records_at)),
        };
        let Some(next) = next.filter(|_| encoding == Encoding::Cdr) else {
            self.cut = Some(RecordingCut { byte: self.records_at, is_damage: true });
            self.stop();
            return Ok(false);
        };
        if damage == Damage::Length {
            self.resume(next)?;
        }
        self.skipped = Some(SkippedParts::with(self.skipped, self.records_at));
        self.channels.are_incomplete = true;
        self.records.extend(named);
        Ok(true)
    }

    /// Goes on at the record that begins at byte `start`.
    fn resume(&mut self, start: u64) -> Result<(), IoError> {
        let system = || IoError::system(&self.path, "read");
        let mut file = File::open(&self.path).map_err(system())?;
        file.seek(SeekFrom::Start(start)).map_err(system())?;
        self.file = Box::new(file);
        self.reader = LinearReader::new_with_options(options(self.max_record).with_skip_start_magic(true));
        self.at = start;
        Ok(())
    }
}

fn options(max_record: usize) -> LinearReaderOptions {
    LinearReaderOptions::default().with_emit_chunks(true).with_record_length_limit(max_record)
}
