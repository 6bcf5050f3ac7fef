//! Digests of outputs: of numbers only, independent of wording.

use super::recording::each_text;
use std::path::{Path, PathBuf};

/// Part of a path that is hashed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quantity {
    /// The numbers of a text file (its letters may change), or the bytes of any other file.
    File,
    /// All files of a folder, by name.
    Folder,
    /// The messages of one of trundle's own topics of a recording: stamps and JSON in order.
    Topic(&'static str),
}

/// A digest: FNV-1a over all bytes, 64 bits, and the number of bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Digest {
    hash: u64,
    bytes: u64,
}

/// Offset basis and prime of the 64-bit FNV-1a hash. Source: Fowler, Noll, Vo, draft-eastlake-fnv.
const FNV_OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;

impl Digest {
    fn empty() -> Self {
        Self { hash: FNV_OFFSET_BASIS, bytes: 0 }
    }

    fn add(&mut self, bytes: &[u8]) {
        self.hash = bytes.iter().fold(self.hash, |hash, &b| (hash ^ u64::from(b)).wrapping_mul(FNV_PRIME));
        self.bytes += bytes.len() as u64;
    }

    /// Digest of `quantity` at `path`.
    ///
    /// # Errors
    /// When the path cannot be read, or is not an MCAP recording although a topic is given.
    pub fn of(quantity: Quantity, path: &Path) -> Result<Self, String> {
        let mut digest = Self::empty();
        match quantity {
            Quantity::File => digest.add_file(path)?,
            Quantity::Folder => {
                for file in sorted_files(path)? {
                    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                    digest.add(name.as_bytes());
                    digest.add_file(&file)?;
                }
            }
            Quantity::Topic(topic) => digest.add_topic(path, topic)?,
        }
        Ok(digest)
    }

    fn add_file(&mut self, path: &Path) -> Result<(), String> {
        let bytes = read(path)?;
        match path.extension().and_then(|e| e.to_str()) {
            Some("txt" | "csv" | "log") => self.add(&without_words(&bytes)),
            _ => self.add(&bytes),
        }
        Ok(())
    }

    fn add_topic(&mut self, path: &Path, topic: &str) -> Result<(), String> {
        let add = |stamp: u64, text: &[u8]| {
            self.add(&stamp.to_le_bytes());
            self.add(text);
        };
        each_text(&read(path)?, topic, add).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(())
    }
}

impl std::fmt::Display for Digest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x} {}", self.hash, self.bytes)
    }
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

fn sorted_files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let unreadable = |error: std::io::Error| format!("cannot list {}: {error}", folder.display());
    let entries = std::fs::read_dir(folder).map_err(unreadable)?;
    let mut files =
        entries.map(|e| e.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    files.sort();
    Ok(files)
}

/// The text's numeric fields, one per line, without headers and column names.
fn without_words(text: &[u8]) -> Vec<u8> {
    let fields = text.split(|b| b" ,;\t\n\r".contains(b));
    let is_number = |field: &&[u8]| {
        std::str::from_utf8(field).is_ok_and(|field| {
            field.parse::<f64>().is_ok_and(|_| field.contains(|c: char| c.is_ascii_digit()))
        })
    };
    fields.filter(is_number).flat_map(|field| field.iter().copied().chain([b'\n'])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(bytes: &[u8]) -> String {
        let mut digest = Digest::empty();
        digest.add(bytes);
        digest.to_string()
    }

    #[test]
    fn the_hash_is_fnv_1a() {
        assert_eq!(digest(b""), "cbf29ce484222325 0");
        assert_eq!(digest(b"a"), "af63dc4c8601ec8c 1");
        assert_eq!(digest(b"foobar"), "85944171f73967e8 6");
    }

    #[test]
    fn words_do_not_count_and_every_digit_does() {
        let numbers = |text: &str| String::from_utf8(without_words(text.as_bytes())).unwrap();
        assert_eq!(numbers("# time way\n1.5,2 -3e-4,nan\n"), "1.5\n2\n-3e-4\n");
        assert_eq!(numbers("t,leg\n1,turn\n"), numbers("time,motion\n1,rotation\n"));
        assert_ne!(numbers("1.25"), numbers("1.26"));
    }

    #[test]
    fn a_missing_file_is_an_error_by_name() {
        let error = Digest::of(Quantity::File, Path::new("no/such.csv")).unwrap_err();
        assert!(error.contains("no/such.csv"), "{error}");
    }
}
