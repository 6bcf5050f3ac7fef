//! The error of reading or writing a file; every message names the file.

use crate::CodecError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;
use trundle_core::{Invalid, Stamp};

/// Reason why a file cannot be read, parsed or written: one sentence with the file's name.
#[derive(Debug, Error)]
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
    /// A value of a file cannot be accepted.
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

    /// An error if `problems` is not empty; the results that could be written are in `folder`.
    pub(crate) fn incomplete(folder: &Path, problems: Vec<Self>) -> Result<(), Self> {
        if problems.is_empty() {
            return Ok(());
        }
        Err(Self::Incomplete { folder: Some(folder.to_owned()), problems })
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

fn incomplete_text(folder: Option<&Path>, problems: &[IoError]) -> String {
    let first = problems.first().map(ToString::to_string).unwrap_or_default();
    let more = match problems.len().saturating_sub(1) {
        0 => String::new(),
        1 => ", nor one other file".to_owned(),
        count => format!(", nor {count} other files"),
    };
    let rest =
        folder.map_or_else(String::new, |folder| format!("; the other results are in {}", folder.display()));
    format!("{first}{more}{rest}")
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
}
