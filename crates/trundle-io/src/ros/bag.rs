//! ROS 2 bags: their files, storage formats and messages.

use super::database::BagDatabase;
use crate::IoError;
use crate::files::read_text;
use crate::recording::{Encoding, MessageStream, RawMessage};
use serde::Deserialize;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The messages of a ROS 2 bag, file after file.
pub(super) struct Bag {
    files: std::vec::IntoIter<PathBuf>,
    open: Option<Storage>,
}

/// One file of a bag.
enum Storage {
    Mcap(Box<MessageStream>),
    Sqlite(BagDatabase),
}

/// What a file begins with.
const MCAP_MAGIC: &[u8] = b"\x89MCAP0\r\n";
const SQLITE_MAGIC: &[u8] = b"SQLite format 3\0";

/// Whether a path is a ROS 2 bag: a folder of one, or a file in one of its two formats.
pub(super) fn is_bag(path: &Path) -> bool {
    if path.is_dir() {
        return path.join("metadata.yaml").exists() || !files_beside(path).is_empty();
    }
    begins_with(path, MCAP_MAGIC) || begins_with(path, SQLITE_MAGIC)
}

fn begins_with(path: &Path, magic: &[u8]) -> bool {
    let mut start = vec![0; magic.len()];
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut start));
    read.is_ok() && start == magic
}

impl Bag {
    /// Opens a folder with its `metadata.yaml`, or else all `.mcap` and `.db3` files in it, or a single file.
    pub(super) fn open(path: &Path) -> Result<Self, IoError> {
        let files = if path.is_dir() { files_of(path)? } else { vec![path.to_owned()] };
        let mut bag = Self { files: files.into_iter(), open: None };
        bag.next_file()?;
        Ok(bag)
    }

    /// The next message; `None` at the end of the last file.
    pub(super) fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        loop {
            let message = match &mut self.open {
                None => return Ok(None),
                Some(Storage::Mcap(stream)) => stream.next_message()?,
                Some(Storage::Sqlite(database)) => database.next_message()?,
            };
            if message.is_some() {
                return Ok(message);
            }
            self.next_file()?;
        }
    }

    fn next_file(&mut self) -> Result<(), IoError> {
        self.open = match self.files.next() {
            None => None,
            Some(path) if begins_with(&path, SQLITE_MAGIC) => {
                Some(Storage::Sqlite(BagDatabase::open(&path)?))
            }
            Some(path) => Some(Storage::Mcap(Box::new(MessageStream::open(&path, Encoding::Cdr)?))),
        };
        Ok(())
    }
}

/// A bag's `metadata.yaml`, as far as it is used.
#[derive(Deserialize)]
struct Metadata {
    rosbag2_bagfile_information: Information,
}

#[derive(Deserialize)]
struct Information {
    relative_file_paths: Vec<PathBuf>,
    #[serde(default)]
    compression_mode: String,
}

fn files_of(folder: &Path) -> Result<Vec<PathBuf>, IoError> {
    let path = folder.join("metadata.yaml");
    let files = if path.exists() {
        let metadata: Metadata = serde_saphyr::from_str(&read_text(&path)?).map_err(|error| {
            IoError::malformed(&path, error.to_string().lines().next().unwrap_or("").to_owned())
        })?;
        let Information { relative_file_paths, compression_mode } = metadata.rosbag2_bagfile_information;
        if !compression_mode.is_empty() && !compression_mode.eq_ignore_ascii_case("none") {
            let problem = format!(
                "compression_mode is {compression_mode}: rosbag2's own compression is not read; `ros2 bag convert` with \
                 storage_id mcap and no compression_mode makes a bag that is"
            );
            return Err(IoError::malformed(&path, problem));
        }
        relative_file_paths.iter().map(|file| beside(folder, file)).collect()
    } else {
        files_beside(folder)
    };
    if files.is_empty() {
        return Err(IoError::malformed(folder, "no .mcap and no .db3 file in it"));
    }
    Ok(files)
}

/// A file of the folder; old bags name it with the folder's own name before it.
fn beside(folder: &Path, file: &Path) -> PathBuf {
    let as_said = folder.join(file);
    match file.file_name() {
        Some(name) if !as_said.exists() => folder.join(name),
        _ => as_said,
    }
}

fn files_beside(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_bag = |path: &PathBuf| path.extension().is_some_and(|e| e == "mcap" || e == "db3");
    let mut files: Vec<PathBuf> = entries.filter(is_bag).collect();
    files.sort();
    files
}
