//! ROS bags: their files, storage formats and messages.

use super::cdr::Wire;
use super::database::BagDatabase;
use super::ros1_bag::Ros1Bag;
use crate::file_kind::is_bag_file;
use crate::files::read_text;
use crate::recording::{Encoding, MessageStream, RawMessage};
use crate::{FileKind, IoError};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The messages of a ROS 2 bag, file after file.
pub(in crate::ros) struct Bag {
    files: std::vec::IntoIter<PathBuf>,
    open: Option<Storage>,
    /// Positions of cuts, one sentence per file.
    pub(in crate::ros) cuts: Vec<String>,
    /// Damaged parts that were left out, one sentence per file.
    pub(in crate::ros) skipped: Vec<String>,
}

/// One file of a bag.
enum Storage {
    Mcap(Box<MessageStream>),
    Sqlite(BagDatabase),
    Ros1(Box<Ros1Bag>),
}

impl Bag {
    /// Opens a folder with its `metadata.yaml`, or all bag files of a folder, or a single file.
    pub(in crate::ros) fn open(path: &Path) -> Result<Self, IoError> {
        let files = if path.is_dir() { files_of(path)? } else { vec![path.to_owned()] };
        let mut bag = Self { files: files.into_iter(), open: None, cuts: Vec::new(), skipped: Vec::new() };
        bag.next_file()?;
        Ok(bag)
    }

    /// The next message; `None` at the end of the last file.
    pub(in crate::ros) fn next_message(&mut self) -> Result<Option<RawMessage>, IoError> {
        loop {
            let message = match &mut self.open {
                None => return Ok(None),
                Some(Storage::Mcap(stream)) => stream.next_message()?,
                Some(Storage::Sqlite(database)) => database.next_message()?,
                Some(Storage::Ros1(bag)) => bag.next_message()?,
            };
            if message.is_some() {
                return Ok(message);
            }
            self.next_file()?;
        }
    }

    /// Serialisation format of the open file's messages.
    pub(in crate::ros) fn wire(&self) -> Wire {
        if matches!(self.open, Some(Storage::Ros1(_))) { Wire::Ros1 } else { Wire::Cdr }
    }

    fn next_file(&mut self) -> Result<(), IoError> {
        if let Some(Storage::Mcap(stream)) = &self.open {
            self.cuts.extend(stream.cut().map(|cut| format!("the bag {}", cut.place())));
            self.skipped.extend(stream.skipped().map(|parts| parts.report()));
        }
        let Some(path) = self.files.next() else {
            self.open = None;
            return Ok(());
        };
        self.open = Some(match FileKind::of(&path)? {
            FileKind::Ros2Sqlite => Storage::Sqlite(BagDatabase::open(&path)?),
            FileKind::Ros1Bag => Storage::Ros1(Box::new(Ros1Bag::open(&path)?)),
            _ => Storage::Mcap(Box::new(MessageStream::open_to_cut(&path, Encoding::Cdr)?)),
        });
        Ok(())
    }
}

/// The used part of a bag's `metadata.yaml`.
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
        let is_mode = |mode: &str| compression_mode.eq_ignore_ascii_case(mode);
        let is_packed_mcap = |file: &PathBuf| file.to_string_lossy().ends_with(".mcap.zstd");
        let is_read = is_mode("")
            || is_mode("none")
            || is_mode("file") && relative_file_paths.iter().all(is_packed_mcap);
        if !is_read {
            let problem = format!(
                "compression_mode is {compression_mode}: of rosbag2's own compression only FILE with storage mcap is read; `ros2 bag \
                 convert` with storage_id mcap and no compression_mode makes a bag that is"
            );
            return Err(IoError::malformed(&path, problem));
        }
        relative_file_paths.iter().map(|file| beside(folder, file)).collect()
    } else {
        files_beside(folder)
    };
    if files.is_empty() {
        return Err(IoError::malformed(folder, "no MCAP and no SQLite file of a ROS 2 bag in it"));
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
    let mut files: Vec<PathBuf> = entries.filter(|path| is_bag_file(path)).collect();
    files.sort();
    files
}
