//! Recognition of folders by their members.

use super::FileKind;
use super::head::head;
use crate::IoError;
use std::path::{Path, PathBuf};

/// The kind of a folder.
pub(super) fn kind_of(dir: &Path) -> Result<FileKind, IoError> {
    let entries = std::fs::read_dir(dir).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let members: Vec<PathBuf> =
        entries.map_err(IoError::system(dir, "read"))?.iter().map(std::fs::DirEntry::path).collect();
    let has = |name: &str| members.iter().any(|member| member.file_name().is_some_and(|own| own == name));
    Ok(if members.is_empty() {
        FileKind::EmptyFolder
    } else if has("rgb.txt") || has("depth.txt") || has("associations.txt") {
        FileKind::SequenceFolder
    } else if has("metadata.yaml") {
        FileKind::Ros2BagFolder
    } else if has("mav0") || has("cam0") {
        FileKind::EurocFolder
    } else {
        of_files(&members)
    })
}

/// The kind of a folder by its recordings.
fn of_files(members: &[PathBuf]) -> FileKind {
    if members.iter().any(|member| is_bag_file(member)) {
        FileKind::Ros2BagFolder
    } else if members.iter().any(|member| kind_of_file(member) == Some(FileKind::TrundleRecording)) {
        FileKind::RunFolder
    } else {
        FileKind::Folder
    }
}

/// Whether a path is a file of a ROS 2 bag. The content of a zstd file is only recognised by its name.
pub(crate) fn is_bag_file(path: &Path) -> bool {
    match kind_of_file(path) {
        Some(FileKind::Ros2Mcap | FileKind::Ros2Sqlite | FileKind::OtherMcap) => true,
        Some(FileKind::Zstd) => {
            path.file_stem().is_some_and(|name| name.to_string_lossy().ends_with(".mcap"))
        }
        _ => false,
    }
}

fn kind_of_file(path: &Path) -> Option<FileKind> {
    let head = path.is_file().then(|| head(path).ok())?;
    Some(FileKind::of_bytes(&head?, u64::MAX))
}
