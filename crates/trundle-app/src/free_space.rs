//! The free space of the disk that a recording is written to.

use std::path::{Path, PathBuf};

/// Free disk space below which recording stops and the run continues \[bytes\]. Source: ours.
pub const MIN_FREE_BYTES: u64 = 1_000_000_000;
/// Messages of a recording between two checks of the free space: some seconds. Source: ours.
const MESSAGES_BETWEEN_CHECKS: u32 = 500;

/// Watches the free space of a disk.
pub struct FreeSpace {
    /// The free space \[bytes\]; `None` if the system does not report it.
    read: Box<dyn Fn() -> Option<u64> + Send>,
    min_free_bytes: u64,
    messages: u32,
}

impl FreeSpace {
    /// The disk of `folder`, and [`MIN_FREE_BYTES`].
    #[must_use]
    pub fn of(folder: &Path) -> Self {
        let folder: PathBuf = folder.to_owned();
        Self::new(move || free_bytes(&folder), MIN_FREE_BYTES)
    }

    /// A disk whose free space `read` reports; recording stops below `min_free_bytes`.
    #[must_use]
    pub fn new(read: impl Fn() -> Option<u64> + Send + 'static, min_free_bytes: u64) -> Self {
        Self { read: Box::new(read), min_free_bytes, messages: 0 }
    }

    /// The free space \[bytes\]; `None` if the system does not report it.
    #[must_use]
    pub fn bytes(&self) -> Option<u64> {
        (self.read)()
    }

    /// Counts a message and checks the disk at intervals. Returns the reason to end the recording, in words, if too little space is free.
    pub fn shortage_at_message(&mut self) -> Option<String> {
        let is_due = self.messages.is_multiple_of(MESSAGES_BETWEEN_CHECKS);
        self.messages = self.messages.wrapping_add(1);
        if is_due { self.shortage() } else { None }
    }

    /// The reason to stop writing, in words, if too little space is free.
    pub fn shortage(&self) -> Option<String> {
        let free = self.bytes().filter(|free| *free < self.min_free_bytes)?;
        let megabytes = |bytes: u64| bytes / 1_000_000;
        let (free, min) = (megabytes(free), megabytes(self.min_free_bytes));
        Some(format!("{free} MB are free on the disk, expected {min} MB or more"))
    }
}

#[cfg(unix)]
pub(crate) fn free_bytes(folder: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    Some(disk.f_bavail.saturating_mul(disk.f_frsize))
}

#[cfg(not(unix))]
pub(crate) fn free_bytes(_folder: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shortage_of_disk_space_is_reported_when_checked() {
        let mut plenty = FreeSpace::new(|| Some(5_000_000), 4_000_000);
        let mut little = FreeSpace::new(|| Some(3_000_000), 4_000_000);
        let mut unknown = FreeSpace::new(|| None, u64::MAX);
        assert_eq!(plenty.shortage_at_message(), None);
        assert_eq!(unknown.shortage_at_message(), None);
        assert_eq!(little.shortage().unwrap(), "3 MB are free on the disk, expected 4 MB or more");
        assert!(little.shortage_at_message().is_some());
        assert!((1..MESSAGES_BETWEEN_CHECKS).all(|_| little.shortage_at_message().is_none()));
        assert!(little.shortage_at_message().is_some());
    }

    #[test]
    #[cfg(unix)]
    fn the_systems_own_disk_tells_its_free_space() {
        assert!(free_bytes(&std::env::temp_dir()).is_some());
    }
}
