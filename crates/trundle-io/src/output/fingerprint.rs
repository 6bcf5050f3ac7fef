//! Checksum of a file's content, which detects edited files.

use std::fmt;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::str::FromStr;

/// Length of the beginning and of the end of a file covered by the checksum \[bytes\]. An edit in between that preserves the length is not
/// detected. Source: ours, a map has less.
const COVERED_BYTES: u64 = 8 << 20;

/// Length and checksum of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fingerprint {
    bytes: u64,
    checksum: u32,
}

impl Fingerprint {
    /// The fingerprint of a file.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(super) fn of(path: &Path) -> io::Result<Self> {
        let mut file = File::open(path)?;
        let bytes = file.metadata()?.len();
        let mut hasher = crc32fast::Hasher::new();
        let mut add = |part: &mut dyn Read| -> io::Result<()> {
            let mut buffer = vec![0; 1 << 16];
            loop {
                match part.read(&mut buffer)? {
                    0 => return Ok(()),
                    read => hasher.update(&buffer[..read]),
                }
            }
        };
        add(&mut (&mut file).take(COVERED_BYTES))?;
        if bytes > COVERED_BYTES {
            file.seek(SeekFrom::Start(COVERED_BYTES.max(bytes - COVERED_BYTES)))?;
            add(&mut file)?;
        }
        Ok(Self { bytes, checksum: hasher.finalize() })
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:08x}", self.bytes, self.checksum)
    }
}

impl FromStr for Fingerprint {
    type Err = std::num::ParseIntError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (bytes, checksum) = text.split_once(' ').unwrap_or((text, ""));
        Ok(Self { bytes: bytes.parse()?, checksum: u32::from_str_radix(checksum, 16)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_at_either_end_and_another_length_are_seen() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("file");
        let of = |content: &[u8]| {
            std::fs::write(&path, content).unwrap();
            Fingerprint::of(&path).unwrap()
        };
        let mut content = vec![7; 3 * COVERED_BYTES as usize];
        let first = of(&content);
        assert_eq!(first.to_string().parse(), Ok(first));
        for edited in [0, content.len() - 1] {
            content[edited] = 8;
            assert_ne!(of(&content), first);
            content[edited] = 7;
        }
        assert_eq!(of(&content), first);
        content.push(7);
        assert_ne!(of(&content), first);
        assert!("12".parse::<Fingerprint>().is_err() && "a b".parse::<Fingerprint>().is_err());
    }
}
