//! Reader of ROS 1 bags, format 2.0: plain and lz4 chunks.

use super::ros1_record::Ros1Record;
use crate::IoError;
use crate::recording::RawMessage;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// Kinds of records, of the field `op`. Source: `wiki.ros.org/Bags/Format/2.0`.
const MESSAGE_OP: u8 = 2;
const CHUNK_OP: u8 = 5;
const CONNECTION_OP: u8 = 7;

/// Longest chunk as unpacked \[bytes\]. A longer one is refused. The limit is a bound for broken files. Source: ours.
const MAX_CHUNK_BYTES: u64 = 1 << 28;
/// Longest first line, which contains the format \[bytes\]. Source: ours.
const MAX_VERSION_BYTES: u64 = 64;

/// The messages of a ROS 1 bag in the order of the file, with one chunk in memory.
pub(super) struct Ros1Bag {
    path: PathBuf,
    file: BufReader<File>,
    /// Number of unread bytes of the file.
    left: u64,
    /// Topic and type of each connection, by id.
    connections: BTreeMap<u32, (String, String)>,
    chunk: Vec<u8>,
    /// Start of the next record in the chunk.
    at: usize,
    /// Note behind the last whole record, if the file is truncated in the chunk.
    cut: Option<IoError>,
}

impl Ros1Bag {
    pub(super) fn open(path: &Path) -> Result<Self, IoError> {
        let system = || IoError::system(path, "read");
        let file = File::open(path).map_err(system())?;
        let len = file.metadata().map_err(system())?.len();
        let mut file = BufReader::new(file);
        let mut version = Vec::new();
        file.by_ref().take(MAX_VERSION_BYTES).read_until(b'\n', &mut version).map_err(system())?;
        if version != b"#ROSBAG V2.0\n" {
            let found = String::from_utf8_lossy(&version).trim().to_owned();
            let problem = format!(
                "a ROS 1 bag of format '{found}', expected '#ROSBAG V2.0'; `rosbag fix OLD.bag NEW.bag` makes one of it"
            );
            return Err(IoError::malformed(path, problem));
        }
        let left = len - version.len() as u64;
        let (connections, chunk) = (BTreeMap::new(), Vec::new());
        Ok(Self { path: path.to_owned(), file, left, connections, chunk, at: 0, cut: None })
    }

    /// The next message; in a cut bag, the complete messages precede the error.
    pub(super) fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        loop {
            if self.at < self.chunk.len() {
                let parsed = Ros1Record::parse(&self.chunk, self.at);
                if parsed.is_err()
                    && let Some(cut) = self.cut.take()
                {
                    self.chunk.clear();
                    return Err(cut);
                }
                let (record, at) = parsed.map_err(|problem| IoError::malformed(&self.path, problem))?;
                let taken = take(&record, &mut self.connections);
                self.at = at;
                if let Some(message) = taken.map_err(|problem| IoError::malformed(&self.path, problem))? {
                    return Ok(Some(message));
                }
            } else if !self.next_chunk()? {
                return Ok(None);
            }
        }
    }

    /// Reads records of the file up to the next chunk. Returns whether a chunk was found.
    fn next_chunk(&mut self) -> Result<bool, IoError> {
        if let Some(cut) = self.cut.take() {
            return Err(cut);
        }
        while self.left > 0 {
            let header = self.part()?;
            let data = self.data_to_cut(&header)?;
            let record = Ros1Record::of_parts(&header, &data);
            let record = record.map_err(|problem| IoError::malformed(&self.path, problem))?;
            if record.kind() == Some(CHUNK_OP) {
                self.chunk = unpacked(&record, self.cut.is_some())
                    .map_err(|problem| IoError::malformed(&self.path, problem))?;
                self.at = 0;
                return Ok(true);
            }
            take(&record, &mut self.connections)
                .map_err(|problem| IoError::malformed(&self.path, problem))?;
        }
        Ok(false)
    }

    /// The data after a header. For a chunk truncated by the end of the file, the available part; `cut` is set then.
    fn data_to_cut(&mut self, header: &[u8]) -> Result<Vec<u8>, IoError> {
        let length = self.length()?;
        let is_chunk = Ros1Record::of_parts(header, &[]).is_ok_and(|record| record.kind() == Some(CHUNK_OP));
        if length > self.left && is_chunk {
            self.cut = Some(self.truncated(length));
            return self.read(self.left);
        }
        self.read(length)
    }

    /// A length and as many bytes.
    fn part(&mut self) -> Result<Vec<u8>, IoError> {
        let length = self.length()?;
        self.read(length)
    }

    /// A length in bytes.
    fn length(&mut self) -> Result<u64, IoError> {
        let length = self.read(4)?;
        let length = u32::from_le_bytes(length.try_into().expect("invariant: four bytes were read"));
        Ok(u64::from(length))
    }

    fn truncated(&self, count: u64) -> IoError {
        let problem = format!(
            "the bag is truncated: {} bytes are left of {count}; `rosbag reindex` mends it",
            self.left
        );
        IoError::malformed(&self.path, problem)
    }

    /// The next `count` bytes; a count beyond the file's rest is refused.
    fn read(&mut self, count: u64) -> Result<Vec<u8>, IoError> {
        if count > self.left {
            return Err(self.truncated(count));
        }
        self.left -= count;
        let mut bytes = Vec::new();
        let read = self.file.by_ref().take(count).read_to_end(&mut bytes);
        read.map_err(IoError::system(&self.path, "read"))?;
        Ok(bytes)
    }
}

/// Stores a connection, gives a message its topic and type.
fn take(
    record: &Ros1Record<'_>,
    connections: &mut BTreeMap<u32, (String, String)>,
) -> Result<Option<RawMessage>, String> {
    match record.kind() {
        Some(CONNECTION_OP) => {
            let about = Ros1Record::of_parts(record.data, &[])?;
            connections.insert(record.number("conn")?, (record.text("topic")?, about.text("type")?));
            Ok(None)
        }
        Some(MESSAGE_OP) => {
            let id = record.number("conn")?;
            let (topic, kind) =
                connections.get(&id).ok_or_else(|| format!("a message on the unknown connection {id}"))?;
            let (topic, schema) = (topic.clone(), kind.clone());
            let data = record.data.to_vec();
            Ok(Some(RawMessage { topic, schema, stamp: Stamp::default(), is_json: false, data }))
        }
        _ => Ok(None),
    }
}

/// The records of a chunk; for a cut chunk, up to the first decompression error.
fn unpacked(record: &Ros1Record<'_>, is_cut: bool) -> Result<Vec<u8>, String> {
    match record.text("compression")?.as_str() {
        "none" => Ok(record.data.to_vec()),
        "lz4" => {
            let mut bytes = Vec::new();
            let decoder = lz4_flex::frame::FrameDecoder::new(record.data);
            let read = decoder.take(MAX_CHUNK_BYTES).read_to_end(&mut bytes);
            match read {
                Err(_) if !is_cut => Err("a chunk is broken: its lz4 data cannot be unpacked".to_owned()),
                _ => Ok(bytes),
            }
        }
        other => Err(format!(
            "a ROS 1 bag packed with {other}, expected none or lz4; `rosbags-convert --src FILE --dst FOLDER` makes a ROS 2 bag of it"
        )),
    }
}
