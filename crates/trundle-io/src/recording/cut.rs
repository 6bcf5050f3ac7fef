//! Position at which an MCAP file was cut, and the complete records of the cut chunk.

use super::chunk_decoder::{CHUNK_HEAD_BYTES, HEAD_BYTES, OwnedRecord, decoded_prefix, split_records};
use mcap::records::op;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Length of the magic number at both ends of an MCAP file \[bytes\].
pub(super) const MAGIC_BYTES: u64 = mcap::MAGIC.len() as u64;

/// Position at which a recording was cut, or is damaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordingCut {
    /// Length of the file, or position of the damaged part \[bytes\].
    pub byte: u64,
    /// Whether the file goes on behind this position.
    pub is_damage: bool,
}

impl RecordingCut {
    /// The cut in one sentence; `seconds`: duration of the data before the cut.
    #[must_use]
    pub fn report(&self, seconds: f64) -> String {
        format!("the recording {}; {seconds:.2} s of it were read", self.place())
    }

    /// The kind and the position of the cut: the predicate of a sentence about the file.
    #[must_use]
    pub fn place(&self) -> String {
        let verb = if self.is_damage { "is damaged" } else { "was cut" };
        format!("{verb} at byte {}", self.byte)
    }
}

/// The part of a file that is whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct WholePart {
    /// End of the last whole record outside of chunks \[bytes\].
    pub end: u64,
    /// Whether the file ends without its end mark.
    pub is_cut: bool,
}

/// All of a file.
pub(super) const WHOLE: WholePart = WholePart { end: u64::MAX, is_cut: false };

/// The whole part of an MCAP file of `len` bytes; all of another file.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn whole_part(file: &mut File, len: u64) -> io::Result<WholePart> {
    let mut reader = BufReader::with_capacity(64, &mut *file);
    let mut start = Vec::new();
    reader.by_ref().take(MAGIC_BYTES).read_to_end(&mut start)?;
    if start != mcap::MAGIC {
        drop(reader);
        return file.rewind().map(|()| WHOLE);
    }
    let mut end = MAGIC_BYTES;
    let mut opcode = 0;
    while opcode != op::FOOTER && len - end >= HEAD_BYTES as u64 {
        let mut head = [0; HEAD_BYTES];
        reader.read_exact(&mut head)?;
        let content = u64::from_le_bytes(head[1..].try_into().unwrap_or_default());
        let next = end.checked_add(HEAD_BYTES as u64).and_then(|start| start.checked_add(content));
        let Some(next) = next.filter(|next| *next <= len) else { break };
        (opcode, end) = (head[0], next);
        reader.seek(SeekFrom::Start(end))?;
    }
    drop(reader);
    let mut mark = Vec::new();
    file.seek(SeekFrom::Start(len - MAGIC_BYTES))?;
    file.read_to_end(&mut mark)?;
    file.rewind()?;
    let is_whole = mark == mcap::MAGIC && len - end >= MAGIC_BYTES;
    Ok(if is_whole { WHOLE } else { WholePart { end, is_cut: true } })
}

/// The complete records of the cut chunk that begins at `start`: opcodes and contents. Empty if another record is at this position.
///
/// # Errors
/// When the file cannot be read.
pub(super) fn records_of_cut_chunk(file: &mut File, start: u64) -> io::Result<Vec<OwnedRecord>> {
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    file.rewind()?;
    let content = match bytes.first() {
        Some(&op::CHUNK) => bytes.get(HEAD_BYTES..).and_then(chunk_content),
        _ => None,
    };
    Ok(content.map(|content| split_records(&content).0).unwrap_or_default())
}

/// The readable records of a chunk.
fn chunk_content(chunk: &[u8]) -> Option<Vec<u8>> {
    let rest = chunk.get(CHUNK_HEAD_BYTES..)?;
    let (length, rest) = rest.split_at_checked(4)?;
    let length = u32::from_le_bytes(length.try_into().ok()?);
    let (compression, rest) = rest.split_at_checked(length as usize)?;
    // Eight bytes of length: a writer that was killed has not filled them in.
    decoded_prefix(compression, rest.get(8..)?)
}
