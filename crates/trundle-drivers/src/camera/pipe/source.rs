//! Pipes, FIFOs, files and standard input, opened with a stoppable reader.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Wait before a FIFO without bytes is read again \[ms\]. Source: ours; a sixth of the time between frames at 60 Hz.
const IDLE_WAIT_MS: u64 = 3;

/// An open source of bytes.
pub(super) struct Source {
    pub reader: Box<dyn Read + Send>,
    /// Whether the end of the bytes is final, as for a file.
    pub is_file: bool,
}

/// Opens a file or FIFO; `-` is standard input. A FIFO is opened immediately, also without a writer.
///
/// # Errors
/// When the path does not exist or is not readable.
pub(super) fn open(path: &Path, is_stopped: Arc<AtomicBool>) -> io::Result<Source> {
    if path.as_os_str() == "-" {
        return Ok(Source { reader: Box::new(io::stdin()), is_file: is_file(io::stdin()) });
    }
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
    let file = options.open(path)?;
    if file.metadata()?.is_file() {
        return Ok(Source { reader: Box::new(file), is_file: true });
    }
    Ok(Source { reader: Box::new(FifoReader { file, has_begun: false, is_stopped }), is_file: false })
}

/// Whether these bytes come from a file, as those of standard input after `< FILE`.
#[cfg(unix)]
fn is_file(input: impl std::os::fd::AsFd) -> bool {
    rustix::fs::fstat(input).is_ok_and(|about| {
        rustix::fs::FileType::from_raw_mode(about.st_mode) == rustix::fs::FileType::RegularFile
    })
}

/// Elsewhere the header decides.
#[cfg(not(unix))]
fn is_file(_: io::Stdin) -> bool {
    false
}

/// A FIFO with non-blocking reads, whose thread ends on request.
struct FifoReader {
    file: File,
    has_begun: bool,
    is_stopped: Arc<AtomicBool>,
}

impl Read for FifoReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while !self.is_stopped.load(Ordering::Relaxed) {
            match self.file.read(buffer) {
                // No writer has opened the other end yet.
                Ok(0) if !self.has_begun => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                result => {
                    self.has_begun = true;
                    return result;
                }
            }
            std::thread::sleep(Duration::from_millis(IDLE_WAIT_MS));
        }
        Ok(0)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_redirected_file_is_a_file_and_a_pipe_is_not() {
        assert!(is_file(tempfile::tempfile().unwrap()));
        assert!(!is_file(std::io::pipe().unwrap().0));
    }
}
