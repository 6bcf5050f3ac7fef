//! Pairs of image files found in a folder that grows.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Extensions of image files. Files with another one, as those still being written under a temporary name, are ignored.
const IMAGE_EXTENSIONS: [&str; 3] = ["png", "jpg", "jpeg"];

/// A pair of files of the same stamp.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FilePair {
    /// Time on the camera's clock \[ns\].
    pub stamp_nanos: i64,
    /// The colour image.
    pub color: PathBuf,
    /// The depth image.
    pub depth: PathBuf,
}

/// The files seen so far.
#[derive(Debug)]
pub(super) struct FolderScan {
    folder: PathBuf,
    max_wait: Duration,
    pending: BTreeMap<i64, SeenPair>,
    last: Option<i64>,
    dropped: u64,
}

#[derive(Debug)]
struct SeenPair {
    color: Option<SeenFile>,
    depth: Option<SeenFile>,
    since: Instant,
}

#[derive(Debug)]
struct SeenFile {
    path: PathBuf,
    bytes: u64,
    is_complete: bool,
}

impl FolderScan {
    /// A scan of the folders `color` and `depth` in `folder`. A file waits at most `max_wait` for its partner.
    pub(super) fn new(folder: &Path, max_wait: Duration) -> Self {
        Self { folder: folder.to_owned(), max_wait, pending: BTreeMap::new(), last: None, dropped: 0 }
    }

    /// Lists both folders. A file is complete if its size has not changed since the previous scan.
    ///
    /// # Errors
    /// When a folder cannot be listed.
    pub(super) fn scan(&mut self, now: Instant) -> io::Result<()> {
        for (name, is_color) in [("color", true), ("depth", false)] {
            for entry in fs::read_dir(self.folder.join(name))? {
                self.record(&entry?, is_color, now);
            }
        }
        Ok(())
    }

    /// The oldest pair, when both of its files are complete. Pairs that waited too long for a file are dropped.
    pub(super) fn take(&mut self, now: Instant) -> Option<FilePair> {
        while let Some(entry) = self.pending.first_entry() {
            let stamp_nanos = *entry.key();
            let pair = entry.get();
            if let (Some(color), Some(depth)) = (complete(&pair.color), complete(&pair.depth)) {
                let found = FilePair { stamp_nanos, color: color.clone(), depth: depth.clone() };
                self.finish(stamp_nanos);
                return Some(found);
            }
            if now.duration_since(pair.since) < self.max_wait {
                return None;
            }
            self.dropped += 1;
            self.finish(stamp_nanos);
        }
        None
    }

    /// Whether no file waits for its partner or completion.
    pub(super) fn is_empty(&self) -> bool {
        self.pending.is_empty()
    }

    /// Number of pairs dropped because one file did not arrive.
    pub(super) fn dropped(&self) -> u64 {
        self.dropped
    }

    fn finish(&mut self, stamp: i64) {
        self.pending.remove(&stamp);
        self.last = Some(stamp);
    }

    /// A file that vanished between listing and reading its size is ignored.
    fn record(&mut self, entry: &fs::DirEntry, is_color: bool, now: Instant) {
        let path = entry.path();
        let Some(stamp) = stamp_of(&path).filter(|stamp| self.last.is_none_or(|last| *stamp > last)) else {
            return;
        };
        let Ok(bytes) = entry.metadata().map(|data| data.len()) else { return };
        let pair = self.pending.entry(stamp);
        let pair = pair.or_insert_with(|| SeenPair { color: None, depth: None, since: now });
        let file = if is_color { &mut pair.color } else { &mut pair.depth };
        match file {
            Some(seen) => {
                seen.is_complete = bytes > 0 && seen.bytes == bytes;
                seen.bytes = bytes;
            }
            None => *file = Some(SeenFile { path, bytes, is_complete: false }),
        }
    }
}

fn complete(file: &Option<SeenFile>) -> Option<&PathBuf> {
    file.as_ref().filter(|file| file.is_complete).map(|file| &file.path)
}

/// The stamp in the name of an image file \[ns\].
fn stamp_of(path: &Path) -> Option<i64> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let is_image = IMAGE_EXTENSIONS.contains(&extension.as_str());
    path.file_stem()?.to_str()?.parse().ok().filter(|_| is_image)
}
