//! The input that is read at this moment, in a file: it outlives the process that reads it.

use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bytes of the length before the input.
const LENGTH_BYTES: usize = 8;

/// The file of the input that is read at this moment.
pub struct CurrentInput(File);

impl CurrentInput {
    pub fn create(folder: &Path) -> Result<Self, String> {
        let path = path(folder);
        File::create(&path).map(Self).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Replaces the previous input.
    pub fn set(&mut self, input: &[u8]) -> Result<(), String> {
        let bytes = [&(input.len() as u64).to_le_bytes()[..], input].concat();
        let written = self.0.seek(SeekFrom::Start(0)).and_then(|_| self.0.write_all(&bytes));
        written.map_err(|error| format!("the current input cannot be written: {error}"))
    }
}

/// The input that a process of this folder read last.
pub fn last_input(folder: &Path) -> Option<Vec<u8>> {
    let bytes = std::fs::read(path(folder)).ok()?;
    let (length, rest) = bytes.split_first_chunk::<LENGTH_BYTES>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    rest.get(..length).map(<[u8]>::to_vec)
}

fn path(folder: &Path) -> PathBuf {
    folder.join("current")
}
