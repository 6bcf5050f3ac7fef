use crate::failure::Failure;
use serde::de::DeserializeOwned;
use std::path::Path;
use trundle::io::IoError;

/// Reads a TOML file.
///
/// # Errors
/// Names the file and why it cannot be read, or the line and what is wrong there.
pub fn read<T: DeserializeOwned>(file: &Path) -> Result<T, Failure> {
    let text = text_of(file)?;
    toml::from_str(&text).map_err(|error| {
        let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
        Failure::Input(format!("{}, line {line}: {}", file.display(), error.message().replace('\n', " ")))
    })
}

/// The text of a file.
///
/// # Errors
/// Names the file and why it cannot be read.
pub fn text_of(file: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(file)
        .map_err(|source| Failure::Io(IoError::System { path: file.to_owned(), action: "read", source }))
}
