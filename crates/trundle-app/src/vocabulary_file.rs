//! Files of visual vocabularies and of their training descriptors.

use crate::AppError;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use trundle_io::{Expected, FileKind, read_text};
use trundle_vision::{Descriptor, Vocabulary};

/// The vocabulary of a file, else the program's own.
///
/// # Errors
/// Names the file and the reason.
pub fn vocabulary_or_builtin(path: Option<&Path>) -> Result<Arc<Vocabulary>, AppError> {
    path.map_or_else(|| Ok(Vocabulary::builtin()), |path| read_vocabulary(path).map(Arc::new))
}

/// The vocabularies of files with the files' names, else the program's own.
///
/// # Errors
/// Names the file and the reason.
pub fn named_vocabularies(paths: &[PathBuf]) -> Result<Vec<(String, Arc<Vocabulary>)>, AppError> {
    if paths.is_empty() {
        return Ok(vec![("built in".to_owned(), Vocabulary::builtin())]);
    }
    let name = |path: &Path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    paths.iter().map(|path| Ok((name(path), Arc::new(read_vocabulary(path)?)))).collect()
}

/// The size of a vocabulary, a row for each number. `milliseconds`: wall-clock time of reading.
#[must_use]
pub fn vocabulary_rows(vocabulary: &Vocabulary, milliseconds: f64) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    vec![
        row("words", vocabulary.word_count().to_string()),
        row("children of a node, at most", vocabulary.branching().to_string()),
        row("levels below the root, at most", vocabulary.depth().to_string()),
        row("size", format!("{} bytes", vocabulary.to_bytes().len())),
        row("read in", format!("{milliseconds:.1} ms")),
    ]
}

/// A vocabulary in our own form.
///
/// # Errors
/// Names the file and the reason.
pub fn read_vocabulary(path: &Path) -> Result<Vocabulary, AppError> {
    Expected::Vocabulary.check(path)?;
    let bytes = std::fs::read(path).map_err(|error| unreadable(path, &error))?;
    Vocabulary::from_bytes(&bytes).map_err(|error| about(path, &error))
}

/// A vocabulary in the text form of DBoW2.
///
/// # Errors
/// Names the file and the reason.
pub fn read_dbow2_vocabulary(path: &Path) -> Result<Vocabulary, AppError> {
    Expected::Dbow2Vocabulary.check(path)?;
    let text = read_text(path)?;
    Vocabulary::from_dbow2_text(&text).map_err(|error| about(path, &error))
}

/// The descriptors of a folder, image by image in the order of the files' names.
///
/// # Errors
/// Names the file and the reason.
pub fn read_descriptors(folder: &Path) -> Result<Vec<Vec<Descriptor>>, AppError> {
    let kind = FileKind::of(folder)?;
    if !folder.is_dir() {
        let problem = format!(
            "this is {kind}, expected a folder of descriptors: a file an image, 32 bytes a descriptor"
        );
        return Err(about(folder, &problem));
    }
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let mut paths: Vec<PathBuf> =
        entries.map_err(|error| unreadable(folder, &error))?.iter().map(std::fs::DirEntry::path).collect();
    paths.sort();
    paths.iter().map(|path| of_image(path)).collect()
}

fn of_image(path: &Path) -> Result<Vec<Descriptor>, AppError> {
    let bytes = std::fs::read(path).map_err(|error| unreadable(path, &error))?;
    if bytes.len() % 32 != 0 {
        let problem = format!("{} bytes, expected 32 a descriptor", bytes.len());
        return Err(AppError::Input(format!("{}: {problem}", path.display())));
    }
    let word = |eight: &[u8]| eight.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
    let descriptor = |bytes: &[u8]| Descriptor(std::array::from_fn(|i| word(&bytes[8 * i..8 * i + 8])));
    Ok(bytes.chunks_exact(32).map(descriptor).collect())
}

fn unreadable(path: &Path, error: &std::io::Error) -> AppError {
    AppError::Input(format!("cannot read {}: {error}", path.display()))
}

fn about(path: &Path, error: &impl std::fmt::Display) -> AppError {
    AppError::Input(format!("{}: {error}", path.display()))
}
