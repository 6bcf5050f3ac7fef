//! Single files that the present command has written.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use trundle_io::{InputFiles, IoError, OutputFile};

/// The files, in the order of writing.
static WRITTEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Writes single files of results, apart from `inputs`, and notes those that are complete. A file that the disk refuses does not keep the
/// others from their place.
///
/// # Errors
/// When a file would replace an input or cannot be made, nothing is written; [`IoError::Incomplete`] names all files that the disk refused.
pub fn write_files(
    inputs: &InputFiles,
    files: impl IntoIterator<Item = (PathBuf, Vec<u8>)>,
) -> Result<(), IoError> {
    let (mut ready, mut problems) = (Vec::new(), Vec::new());
    for (path, bytes) in files {
        match OutputFile::create_apart_from(inputs, &path) {
            Ok(file) => ready.push((file, path, bytes)),
            Err(problem) if problem.is_incomplete() => problems.push(problem),
            Err(problem) => return Err(problem),
        }
    }
    for (file, path, bytes) in ready {
        match file.write(&bytes) {
            Ok(()) => note_written(&path),
            Err(problem) => problems.push(problem),
        }
    }
    IoError::incomplete(None, problems)
}

/// Notes a file that is written completely.
fn note_written(file: &Path) {
    WRITTEN.lock().unwrap_or_else(PoisonError::into_inner).push(file.to_owned());
}

/// The files written so far, for a person.
#[must_use]
pub fn written_text() -> String {
    text_of(&WRITTEN.lock().unwrap_or_else(PoisonError::into_inner))
}

fn text_of(files: &[PathBuf]) -> String {
    match files {
        [] => "nothing was written".to_owned(),
        [file] => format!("only {} was written", file.display()),
        [first, .., last] => format!("{} to {} were written", first.display(), last.display()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn a_file_that_the_disk_refuses_does_not_keep_the_others_from_their_place() {
        let scratch = tempfile::tempdir().unwrap();
        let whole = scratch.path().join("map.yaml");
        let full = PathBuf::from("/dev/full");
        let files = [&full, &whole].map(|path| (path.clone(), b"1".to_vec()));
        let error = write_files(&InputFiles::default(), files).unwrap_err();
        assert!(error.is_incomplete() && error.to_string().contains("/dev/full"), "{error}");
        assert_eq!(std::fs::read(&whole).unwrap(), b"1");
    }

    #[test]
    fn the_first_and_the_last_file_are_named() {
        let files: Vec<PathBuf> = ["a.yaml", "b.pgm", "c.csv"].map(PathBuf::from).to_vec();
        assert_eq!(text_of(&[]), "nothing was written");
        assert_eq!(text_of(&files[..1]), "only a.yaml was written");
        assert_eq!(text_of(&files), "a.yaml to c.csv were written");
    }
}
