//! Whether two paths lead to the same file or folder.

use std::path::{Path, PathBuf};

/// The file or folder that a path leads to, links followed: device and inode, elsewhere the canonical path.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct FileIdentity(Inner);

#[cfg(unix)]
type Inner = (u64, u64);
#[cfg(not(unix))]
type Inner = PathBuf;

impl FileIdentity {
    /// `None` if the path does not exist.
    #[cfg(unix)]
    pub(super) fn of(path: &Path) -> Option<Self> {
        use std::os::unix::fs::MetadataExt;
        std::fs::metadata(path).ok().map(|meta| Self((meta.dev(), meta.ino())))
    }

    /// `None` if the path does not exist.
    #[cfg(not(unix))]
    pub(super) fn of(path: &Path) -> Option<Self> {
        std::fs::canonicalize(path).ok().map(Self)
    }
}

/// The absolute path, with links followed as far as the path exists.
pub(super) fn resolved(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let found = absolute.ancestors().find_map(|part| Some((part, std::fs::canonicalize(part).ok()?)));
    match found {
        Some((part, real)) => match absolute.strip_prefix(part) {
            Ok(rest) if rest.as_os_str().is_empty() => real,
            Ok(rest) => real.join(rest),
            Err(_) => absolute,
        },
        None => absolute,
    }
}

/// Whether both paths lead to the same place, or would when it is made.
pub(super) fn is_same(a: &Path, b: &Path) -> bool {
    match (FileIdentity::of(a), FileIdentity::of(b)) {
        (Some(a), Some(b)) => a == b,
        (None, None) => resolved(a) == resolved(b),
        _ => false,
    }
}

/// Whether the two folders are on different disks, between which a rename fails.
#[cfg(unix)]
pub(super) fn is_on_other_disk(a: &Path, b: &Path) -> bool {
    let disk = |path| FileIdentity::of(path).map(|identity| identity.0.0);
    matches!((disk(a), disk(b)), (Some(a), Some(b)) if a != b)
}

/// Whether the two folders are on different disks, if the system reports it.
#[cfg(not(unix))]
pub(super) fn is_on_other_disk(_a: &Path, _b: &Path) -> bool {
    false
}
