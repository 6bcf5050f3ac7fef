//! The file that marks a folder as written by trundle, with a list of the written files.

use super::fingerprint::Fingerprint;
use super::tree::files_below;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// Name of the file that marks a folder as written by trundle; it lists the written files.
pub(super) const MARKER_FILE: &str = ".trundle-run";

/// The first line of the marker file.
const TITLE: &str = "# A folder of results of trundle.";
/// The line of a marker of possibly incomplete results, left by an interrupted commit.
const UNFINISHED: &str = "# Unfinished.";
/// Separator between the path of a file and its checksum in the marker.
const SEPARATOR: char = '\t';
/// The rest of the marker's head.
const HEAD: &str =
    "# The next run into this folder keeps these files in a folder beside it, whose name ends in .1.\n";

/// The files of a run, by their paths in its folder.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct RunMarker {
    /// `None` if the content is not known.
    files: BTreeMap<PathBuf, Option<Fingerprint>>,
    /// Whether the files may be incomplete.
    pub(super) is_unfinished: bool,
}

impl RunMarker {
    /// The marker of all files below `folder`.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub(super) fn of(folder: &Path) -> io::Result<Self> {
        let entry =
            |path: PathBuf| Some((path.strip_prefix(folder).ok()?.to_owned(), Fingerprint::of(&path).ok()));
        let files = files_below(folder)?.into_iter().filter_map(entry).collect();
        Ok(Self { files, is_unfinished: false })
    }

    /// The marker of a folder during the replacement of the files of `self` by those of `next`.
    pub(super) fn giving_place_to(self, next: Self) -> Self {
        Self { files: self.files.into_iter().chain(next.files).collect(), is_unfinished: true }
    }

    /// The marker in `folder`; `None` without a marker by trundle.
    pub(super) fn read(folder: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(folder.join(MARKER_FILE)).ok()?;
        let mut lines = text.lines();
        (lines.next() == Some(TITLE)).then_some(())?;
        let is_unfinished = text.lines().any(|line| line == UNFINISHED);
        Some(Self { files: lines.filter(|line| !line.starts_with('#')).map(entry).collect(), is_unfinished })
    }

    /// Writes the marker into `folder`.
    ///
    /// # Errors
    /// When the marker cannot be written.
    pub(super) fn write(&self, folder: &Path) -> io::Result<()> {
        let lines = self.files.iter().map(|(path, content)| {
            let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
            let content = content.map_or_else(String::new, |content| format!("{SEPARATOR}{content}"));
            parts.join("/") + &content + "\n"
        });
        let state = if self.is_unfinished { format!("{UNFINISHED}\n") } else { String::new() };
        let text = format!("{TITLE}\n{HEAD}{state}{}", lines.collect::<String>());
        std::fs::write(folder.join(MARKER_FILE), text)
    }

    /// The files of `folder` that were changed after the run. Files without a checksum count as unchanged.
    pub(super) fn changed_files(&self, folder: &Path) -> Vec<PathBuf> {
        let is_changed = |path: &PathBuf, content: &Fingerprint| {
            Fingerprint::of(&folder.join(path)).is_ok_and(|found| found != *content)
        };
        let changed = self
            .files
            .iter()
            .filter(|(path, content)| content.as_ref().is_some_and(|content| is_changed(path, content)));
        changed.map(|(path, _)| path.clone()).collect()
    }

    /// The files of `folder` that the run did not write.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub(super) fn foreign_files(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let found = files_below(folder)?
            .into_iter()
            .filter_map(|path| Some(path.strip_prefix(folder).ok()?.to_owned()));
        Ok(found.filter(|path| path != Path::new(MARKER_FILE) && !self.files.contains_key(path)).collect())
    }
}

/// A line of the marker: the path, and behind a separator the content. Lines without one are of trundle 0.1.0.
fn entry(line: &str) -> (PathBuf, Option<Fingerprint>) {
    let parts = line.rsplit_once(SEPARATOR);
    let known = parts.and_then(|(path, content)| Some((path.into(), Some(content.parse().ok()?))));
    known.unwrap_or_else(|| (line.into(), None))
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
        assert!(marker.changed_files(folder).is_empty());
        fs::write(folder.join("a.txt"), "2").unwrap();
        assert_eq!(marker.changed_files(folder), [Path::new("a.txt")]);
        fs::write(folder.join("rgb/notes"), "mine").unwrap();
        assert_eq!(marker.foreign_files(folder).unwrap(), [Path::new("rgb/notes")]);
        fs::write(folder.join(MARKER_FILE), format!("{TITLE}\na.txt\nrgb/1.png\n")).unwrap();
        let former = RunMarker::read(folder).unwrap();
        assert!(former.changed_files(folder).is_empty(), "of an unknown content");
        assert_eq!(former.foreign_files(folder).unwrap(), [Path::new("rgb/notes")]);
        let changing = marker.giving_place_to(former);
        changing.write(folder).unwrap();
        assert!(changing.is_unfinished && RunMarker::read(folder) == Some(changing));
        fs::write(folder.join(MARKER_FILE), "something else").unwrap();
        assert_eq!(RunMarker::read(folder), None);
    }
}
