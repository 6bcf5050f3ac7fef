//! The error of reading or writing a file; every message names the file.

use crate::CodecError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;
use trundle_core::{Invalid, Stamp};

/// Reason why a file cannot be read, parsed or written: one sentence with the file's name.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IoError {
    /// The operating system refused.
    #[error("cannot {action} {path}: {reason}", path = path.display(), reason = reason(source))]
    System {
        /// The file or folder.
        path: PathBuf,
        /// `read`, `write`, ...
        action: &'static str,
        /// The system's error.
        source: std::io::Error,
    },
    /// A line of a text file is wrong.
    #[error("{path}, line {line}: {problem}", path = path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The problem, with the value and its unit.
        problem: String,
    },
    /// A value of a file is invalid.
    #[error("{path}: {problem}", path = path.display())]
    Field {
        /// The file.
        path: PathBuf,
        /// The value, and the accepted values.
        problem: Box<Invalid>,
    },
    /// An image cannot be read or made.
    #[error("{path}: {problem}", path = path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// The problem.
        problem: Box<CodecError>,
    },
    /// The work is done, but its results could not all be written.
    #[error("{}", incomplete_text(folder.as_deref(), problems))]
    Incomplete {
        /// Folder of the results that could be written.
        folder: Option<PathBuf>,
        /// Reasons for the missing results, one or more.
        problems: Vec<IoError>,
    },
    /// The file as a whole is invalid.
    #[error("{path}: {problem}", path = path.display())]
    Malformed {
        /// The file or folder.
        path: PathBuf,
        /// The problem.
        problem: String,
    },
    /// A file or folder of another kind.
    #[error("{path}: this is {found}, expected {expected}{remedy}", path = path.display(), remedy = clause(remedy))]
    WrongKind {
        /// The file or folder.
        path: PathBuf,
        /// Kind of the file.
        found: &'static str,
        /// The accepted content.
        expected: &'static str,
        /// The remedy, if one is known.
        remedy: &'static str,
    },
}

impl IoError {
    /// The file or folder of the error.
    pub fn path(&self) -> &Path {
        match self {
            Self::System { path, .. }
            | Self::Line { path, .. }
            | Self::Field { path, .. }
            | Self::Image { path, .. }
            | Self::Malformed { path, .. }
            | Self::WrongKind { path, .. } => path,
            Self::Incomplete { folder: Some(folder), .. } => folder,
            Self::Incomplete { problems, .. } => problems.first().map_or(Path::new(""), Self::path),
        }
    }

    /// The same sentence without the file.
    pub fn problem(&self) -> String {
        let whole = self.to_string();
        let named = self.path().display().to_string();
        match whole.split_once(&named) {
            Some(("", after)) => after.trim_start_matches([':', ',', ' ']).to_owned(),
            Some((before, after)) => format!("{}{after}", before.trim_end()),
            None => whole,
        }
    }

    /// Whether the work is done, but a disk did not take all of its results.
    #[must_use]
    pub fn is_incomplete(&self) -> bool {
        match self {
            Self::Incomplete { .. } => true,
            Self::System { action, source, .. } => *action == WRITE && is_refusal_of_disk(source),
            _ => false,
        }
    }

    /// An error if `problems` is not empty; `folder` holds the results that could be written.
    ///
    /// # Errors
    /// [`IoError::Incomplete`] with these problems.
    pub fn incomplete(folder: Option<&Path>, problems: Vec<Self>) -> Result<(), Self> {
        if problems.is_empty() {
            return Ok(());
        }
        Err(Self::Incomplete { folder: folder.map(Path::to_owned), problems })
    }

    /// Results that standard output did not take.
    #[must_use]
    pub fn unprinted(error: &std::io::Error) -> Self {
        let source =
            error.raw_os_error().map_or_else(|| error.kind().into(), std::io::Error::from_raw_os_error);
        let problem = Self::System { path: "standard output".into(), action: "write to", source };
        Self::Incomplete { folder: None, problems: vec![problem] }
    }

    pub(crate) fn system(path: &Path, action: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::System { path: path.to_owned(), action, source }
    }

    pub(crate) fn line(path: &Path, line: usize, problem: impl Into<String>) -> Self {
        Self::Line { path: path.to_owned(), line, problem: problem.into() }
    }

    pub(crate) fn field(path: &Path) -> impl FnOnce(Invalid) -> Self {
        move |problem| Self::Field { path: path.to_owned(), problem: Box::new(problem) }
    }

    pub(crate) fn image(path: &Path) -> impl FnOnce(CodecError) -> Self {
        move |problem| Self::Image { path: path.to_owned(), problem: Box::new(problem) }
    }

    /// An image of the file at `path` that cannot be decoded.
    #[must_use]
    pub fn bad_image(path: &Path, problem: CodecError) -> Self {
        Self::image(path)(problem)
    }

    /// A colour image of `found` px (width and height); the camera has `expected`.
    #[must_use]
    pub fn wrong_image_size(path: &Path, found: (usize, usize), expected: (usize, usize)) -> Self {
        let expected = format!("{} x {} as the camera", expected.0, expected.1);
        let size = format!("{} x {}", found.0, found.1);
        Self::field(path)(Invalid::new("colour image size", size, "px", expected))
    }

    pub(crate) fn malformed(path: &Path, problem: impl Into<String>) -> Self {
        Self::Malformed { path: path.to_owned(), problem: problem.into() }
    }
}

/// A further clause of a sentence; empty for empty text.
fn clause(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("; {text}") }
}

/// The action of a system's error when results are written.
const WRITE: &str = "write";

/// Largest number of files that the sentence about incomplete results names. The log names all. Source: ours.
const MAX_NAMED_FILES: usize = 20;

fn incomplete_text(folder: Option<&Path>, problems: &[IoError]) -> String {
    let first = problems.first().map(ToString::to_string).unwrap_or_default();
    let mut others: Vec<String> = Vec::new();
    for problem in problems.iter().skip(1).filter(|other| other.path() != problems[0].path()) {
        let path = folder
            .map_or(problem.path(), |folder| problem.path().strip_prefix(folder).unwrap_or(problem.path()));
        let name = path.display().to_string();
        others.extend((!others.contains(&name)).then_some(name));
    }
    let more = others.len().saturating_sub(MAX_NAMED_FILES);
    others.truncate(MAX_NAMED_FILES);
    others.extend((more > 0).then(|| format!("{more} other files")));
    let others = if others.is_empty() { String::new() } else { format!(", nor {}", others.join(", ")) };
    let rest =
        folder.map_or_else(String::new, |folder| format!("; the other results are in {}", folder.display()));
    format!("{first}{others}{rest}")
}

/// Whether the disk is full, used up or broken, rather than the name wrong.
pub(crate) fn is_refusal_of_disk(error: &std::io::Error) -> bool {
    use ErrorKind::{FileTooLarge, QuotaExceeded, ReadOnlyFilesystem, StorageFull, WriteZero};
    let kinds = [StorageFull, QuotaExceeded, FileTooLarge, ReadOnlyFilesystem, WriteZero];
    kinds.contains(&error.kind()) || is_device_error(error)
}

#[cfg(unix)]
fn is_device_error(error: &std::io::Error) -> bool {
    const EIO: i32 = 5;
    error.raw_os_error() == Some(EIO)
}

#[cfg(not(unix))]
fn is_device_error(_error: &std::io::Error) -> bool {
    false
}

/// The operating system's error in plain words.
pub(crate) fn reason(error: &std::io::Error) -> String {
    let plain = match error.kind() {
        ErrorKind::NotFound => "it does not exist",
        ErrorKind::PermissionDenied => "no permission",
        ErrorKind::StorageFull => "the disk is full",
        ErrorKind::FileTooLarge => {
            "the file would be larger than the system allows (`ulimit -f`, or the kind of the disk)"
        }
        ErrorKind::QuotaExceeded => "the disk quota is used up",
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only",
        ErrorKind::IsADirectory => "it is a folder",
        ErrorKind::AlreadyExists => "a file is in the way",
        ErrorKind::NotADirectory => "a part of its path is not a folder",
        _ => return error.to_string(),
    };
    plain.to_owned()
}

/// A frame of a sequence that cannot be used; the next one may be.
#[derive(Debug, Error)]
#[error("frame {index} at {stamp} s: {source}")]
pub struct FrameError {
    /// Index of the frame, from 0.
    pub index: usize,
    /// Stamp of the frame.
    pub stamp: Stamp,
    /// The problem.
    pub source: IoError,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_called_so() {
        let error = IoError::system(Path::new("out/map.pgm"), "write")(ErrorKind::StorageFull.into());
        assert_eq!(error.to_string(), "cannot write out/map.pgm: the disk is full");
        assert_eq!(error.path(), Path::new("out/map.pgm"));
    }

    #[test]
    fn results_that_a_disk_refused_at_the_end_are_incomplete_and_a_place_that_cannot_be_made_is_not() {
        let error = |action, kind: ErrorKind| IoError::system(Path::new("bag.mcap"), action)(kind.into());
        assert!(error("write", ErrorKind::StorageFull).is_incomplete());
        assert!(error("write", ErrorKind::FileTooLarge).is_incomplete());
        assert!(!error("create", ErrorKind::StorageFull).is_incomplete());
        assert!(!error("write", ErrorKind::PermissionDenied).is_incomplete());
    }

    #[test]
    fn each_missing_file_is_named_once() {
        let problem = |i: usize| IoError::malformed(&Path::new("out").join(i.to_string()), "full");
        let text = |count: usize| {
            let problems = (0..count).flat_map(|i| [problem(i), problem(i)]).collect();
            IoError::Incomplete { folder: Some("out".into()), problems }.to_string()
        };
        assert_eq!(text(1), "out/0: full; the other results are in out");
        assert_eq!(text(3), "out/0: full, nor 1, 2; the other results are in out");
        assert!(text(30).ends_with(", nor 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 9 other files; the other results are in out"));
    }
}
