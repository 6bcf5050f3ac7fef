//! Single files that the present command has written.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The files, in the order of writing.
static WRITTEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Notes a file that is written completely.
pub fn note_written(file: &Path) {
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
    fn the_first_and_the_last_file_are_named() {
        let files: Vec<PathBuf> = ["a.yaml", "b.pgm", "c.csv"].map(PathBuf::from).to_vec();
        assert_eq!(text_of(&[]), "nothing was written");
        assert_eq!(text_of(&files[..1]), "only a.yaml was written");
        assert_eq!(text_of(&files), "a.yaml to c.csv were written");
    }
}
