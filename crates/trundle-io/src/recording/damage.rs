//! Damaged parts of an MCAP file: their descriptions, and the summary that leads past them.

use super::channels::Encoding;
use super::chunk_decoder::{HEAD_BYTES, OwnedRecord, split_records};
use super::cut::MAGIC_BYTES;
use super::record_parser::MAX_RECORD;
use crate::IoError;
use mcap::McapError;
use mcap::records::op;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Length of the end of a file: footer and magic number \[bytes\]. Source: MCAP specification, "Footer".
const END_BYTES: usize = HEAD_BYTES + 8 + 8 + 4 + mcap::MAGIC.len();
/// Position of the chunk's start in a chunk index \[bytes\]. Source: MCAP specification, "Chunk Index".
const INDEXED_START: std::ops::Range<usize> = 16..24;

/// What is damaged at a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Damage {
    /// The content of a chunk. The next record is known.
    Chunk,
    /// The length of a record. The next record is unknown.
    Length,
}

/// Damaged parts that were left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SkippedParts {
    /// Number of parts.
    pub count: usize,
    /// Position of the first part \[bytes\].
    pub first: u64,
}

impl SkippedParts {
    /// The parts with one more at byte `at`.
    pub(super) fn with(parts: Option<Self>, at: u64) -> Self {
        parts.map_or(Self { count: 1, first: at }, |Self { count, first }| Self { count: count + 1, first })
    }

    /// The parts in one sentence.
    pub(crate) fn report(&self) -> String {
        let Self { count, first } = self;
        match count {
            1 => format!("the bag is damaged at byte {first}; the messages of that chunk are left out"),
            _ => format!(
                "the bag is damaged at {count} places, the first at byte {first}; the messages of these chunks are left out"
            ),
        }
    }
}

/// The error of a recording that cannot be read at byte `at`.
pub(super) fn broken(path: &Path, encoding: Encoding, at: u64, error: &McapError) -> IoError {
    let hint = if encoding == Encoding::Own { "; --recover reads it to there" } else { "" };
    let problem = match error {
        McapError::BadMagic if at == MAGIC_BYTES => "not an MCAP recording".to_owned(),
        // A chunk that is longer than the file, within what chunks have.
        McapError::RecordTooLarge { opcode: op::CHUNK, len } if *len <= MAX_RECORD as u64 => {
            format!("the recording is truncated: it ends in the middle of a chunk of {len} bytes{hint}")
        }
        McapError::UnexpectedEof => {
            format!("the recording is truncated: it ends in the middle of the record at byte {at}{hint}")
        }
        other => format!("the recording is damaged at byte {at}: {}{hint}", reason(other)),
    };
    IoError::malformed(path, problem)
}

fn reason(error: &McapError) -> String {
    match error {
        McapError::BadChunkCrc { .. } => "the checksum of a chunk does not match its content".to_owned(),
        McapError::DecompressionError(_) => "a chunk cannot be decompressed".to_owned(),
        McapError::UnsupportedCompression(name) => {
            format!("a chunk is compressed with '{name}', expected none, lz4 or zstd")
        }
        McapError::BadMagic => "the mark at the end of the file is missing".to_owned(),
        McapError::RecordTooLarge { len, .. } => {
            format!("a length of {len} bytes is longer than its record or the file")
        }
        _ => "a record is shorter than its content".to_owned(),
    }
}

/// The summary at the end of a file; empty for a file without one.
#[derive(Debug, Default)]
pub(super) struct Summary {
    /// Schemas and channels.
    pub(super) named: Vec<OwnedRecord>,
    pub(super) chunks: ChunkStarts,
}

/// Starts of the chunks of a file \[bytes\].
#[derive(Debug, Default)]
pub(super) struct ChunkStarts(Vec<u64>);

impl ChunkStarts {
    /// The start of the first chunk behind byte `at`.
    pub(super) fn behind(&self, at: u64) -> Option<u64> {
        self.0.iter().copied().filter(|start| *start > at).min()
    }
}

impl Summary {
    /// The summary of a file that is not packed.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(super) fn read(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let len = file.metadata()?.len();
        let Some(end) = len.checked_sub(END_BYTES as u64) else { return Ok(Self::default()) };
        let footer = read_part(&mut file, end, len)?;
        let start = footer.get(HEAD_BYTES..HEAD_BYTES + 8).map_or(0, u64_of);
        if footer.first() != Some(&op::FOOTER) || !footer.ends_with(mcap::MAGIC) || start == 0 || start > end
        {
            return Ok(Self::default());
        }
        let (records, _) = split_records(&read_part(&mut file, start, end)?);
        let indexes = records.iter().filter(|(opcode, _)| *opcode == op::CHUNK_INDEX);
        let chunks = indexes.filter_map(|(_, index)| index.get(INDEXED_START).map(u64_of)).collect();
        let named = records.into_iter().filter(|(opcode, _)| matches!(*opcode, op::SCHEMA | op::CHANNEL));
        Ok(Self { named: named.collect(), chunks: ChunkStarts(chunks) })
    }
}

fn read_part(file: &mut File, start: u64, end: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.take(end - start).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn u64_of(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes.try_into().unwrap_or_default())
}
