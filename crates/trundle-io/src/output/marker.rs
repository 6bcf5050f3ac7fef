//! The file by which trundle knows a folder that it wrote, and what it wrote there.

use super::tree::files_below;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

/// The file by which trundle knows a folder that it wrote: a list of what it wrote there.
pub(super) const MARKER_FILE: &str = ".trundle-run";

/// The first line of the marker file.
const TITLE: &str = "# A folder of results of trundle.";
/// The rest of its head.
const HEAD: &str =
    "# The next run into this folder keeps these files in a folder beside it, whose name ends in .1.\n";

/// The files that a run wrote into its folder, by their paths in it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct RunMarker {
    files: BTreeSet<PathBuf>,
}

impl RunMarker {
    /// The marker of everything below `folder`.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub(super) fn of(folder: &Path) -> io::Result<Self> {
        let inside = |path: PathBuf| path.strip_prefix(folder).map(Path::to_owned).ok();
        Ok(Self { files: files_below(folder)?.into_iter().filter_map(inside).collect() })
    }

    /// The marker in `folder`; `None` where there is none of trundle's.
    pub(super) fn read(folder: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(folder.join(MARKER_FILE)).ok()?;
        let mut lines = text.lines();
        (lines.next() == Some(TITLE)).then_some(())?;
        Some(Self { files: lines.filter(|line| !line.starts_with('#')).map(PathBuf::from).collect() })
    }

    /// Writes the marker into `folder`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn write(&self, folder: &Path) -> io::Result<()> {
        let lines = self.files.iter().map(|path| {
            let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
            parts.join("/") + "\n"
        });
        std::fs::write(folder.join(MARKER_FILE), format!("{TITLE}\n{HEAD}{}", lines.collect::<String>()))
    }

    /// The files of `folder` that the run did not write.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub(super) fn foreign_files(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let found = Self::of(folder)?.files.into_iter();
        Ok(found.filter(|path| path != Path::new(MARKER_FILE) && !self.files.contains(path)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_marker_is_the_same_after_writing_and_knows_what_is_foreign() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        fs::create_dir(folder.join("rgb")).unwrap();
        ["a.txt", "rgb/1.png"].iter().for_each(|name| fs::write(folder.join(name), "1").unwrap());
        let marker = RunMarker::of(folder).unwrap();
        assert_eq!(RunMarker::read(folder), None);
        marker.write(folder).unwrap();
        assert_eq!(RunMarker::read(folder), Some(marker.clone()));
        assert!(marker.foreign_files(folder).unwrap().is_empty());
        fs::write(folder.join("rgb/notes"), "mine").unwrap();
        assert_eq!(marker.foreign_files(folder).unwrap(), [Path::new("rgb/notes")]);
        fs::write(folder.join(MARKER_FILE), "something else").unwrap();
        assert_eq!(RunMarker::read(folder), None);
    }
}
