//! Reader of ROS 1 bags, format 2.0: plain and lz4 chunks.

use super::ros1_record::Ros1Record;
use crate::IoError;
use crate::recording::RawMessage;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use trundle_core::Stamp;

/// Kinds of records, of the field `op` (`wiki.ros.org/Bags/Format/2.0`).
const MESSAGE_OP: u8 = 2;
const CHUNK_OP: u8 = 5;
const CONNECTION_OP: u8 = 7;

/// Longest chunk as unpacked \[bytes\]. A longer one is refused. It bounds what a broken file can ask for. Source: ours.
const MAX_CHUNK_BYTES: u64 = 1 << 28;
/// Longest first line, which names the format \[bytes\].
const MAX_VERSION_BYTES: u64 = 64;

/// The messages of a ROS 1 bag in the order of the file, a chunk in memory at a time.
pub(super) struct Ros1Bag {
    path: PathBuf,
    file: BufReader<File>,
    /// Bytes of the file that are not yet read.
    left: u64,
    /// By id: topic and type.
    connections: BTreeMap<u32, (String, String)>,
    chunk: Vec<u8>,
    /// Where the next record of the chunk begins.
    at: usize,
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
        Ok(Self { path: path.to_owned(), file, left, connections: BTreeMap::new(), chunk: Vec::new(), at: 0 })
    }

    pub(super) fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        loop {
            if self.at < self.chunk.len() {
                let (record, at) = Ros1Record::parse(&self.chunk, self.at)
                    .map_err(|problem| IoError::malformed(&self.path, problem))?;
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

    /// Reads records of the file up to the next chunk; whether there is one.
    fn next_chunk(&mut self) -> Result<bool, IoError> {
        while self.left > 0 {
            let header = self.part()?;
            let data = self.part()?;
            let record = Ros1Record::of_parts(&header, &data);
            let record = record.map_err(|problem| IoError::malformed(&self.path, problem))?;
            if record.kind() == Some(CHUNK_OP) {
                self.chunk = unpacked(&record).map_err(|problem| IoError::malformed(&self.path, problem))?;
                self.at = 0;
                return Ok(true);
            }
            take(&record, &mut self.connections)
                .map_err(|problem| IoError::malformed(&self.path, problem))?;
        }
        Ok(false)
    }

    /// A length and as many bytes.
    fn part(&mut self) -> Result<Vec<u8>, IoError> {
        let length = self.read(4)?;
        let length = u32::from_le_bytes(length.try_into().expect("invariant: four bytes were read"));
        self.read(u64::from(length))
    }

    /// The next `count` bytes: no more are asked for than the file has.
    fn read(&mut self, count: u64) -> Result<Vec<u8>, IoError> {
        if count > self.left {
            let problem = format!(
                "the bag is truncated: {} bytes are left of {count}; `rosbag reindex` mends it",
                self.left
            );
            return Err(IoError::malformed(&self.path, problem));
        }
        self.left -= count;
        let mut bytes = Vec::new();
        let read = self.file.by_ref().take(count).read_to_end(&mut bytes);
        read.map_err(IoError::system(&self.path, "read"))?;
        Ok(bytes)
    }
}

/// Remembers a connection, gives a message its topic and type.
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
            Ok(Some(RawMessage { topic, schema, stamp: Stamp::default(), data: record.data.to_vec() }))
        }
        _ => Ok(None),
    }
}

/// The records of a chunk.
fn unpacked(record: &Ros1Record<'_>) -> Result<Vec<u8>, String> {
    match record.text("compression")?.as_str() {
        "none" => Ok(record.data.to_vec()),
        "lz4" => {
            let mut bytes = Vec::new();
            let decoder = lz4_flex::frame::FrameDecoder::new(record.data);
            let read = decoder.take(MAX_CHUNK_BYTES).read_to_end(&mut bytes);
            read.map_err(|_| "a chunk is broken: its lz4 data cannot be unpacked".to_owned())?;
            Ok(bytes)
        }
        other => Err(format!(
            "a ROS 1 bag packed with {other}, expected none or lz4; `rosbags-convert --src FILE --dst FOLDER` makes a ROS 2 bag of it"
        )),
    }
}
