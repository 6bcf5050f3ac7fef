//! Disk space and the right to write, of the folder that runs write to.

use super::check::Check;
use crate::free_space::{MIN_FREE_BYTES, free_bytes};
use std::path::Path;

/// Free space below which a long recording does not fit \[bytes\]: half an hour of a recording. Source: `trundle run`'s announcement.
const LOW_FREE_BYTES: u64 = 10_000_000_000;

/// The check of the folder, or of the first of its parents that exists.
pub fn check(output: &Path) -> Vec<Check> {
    let absolute = std::path::absolute(output).unwrap_or_else(|_| output.to_owned());
    let existing = absolute.ancestors().find(|folder| folder.is_dir()).unwrap_or(Path::new("/"));
    vec![folder(existing)]
}

fn folder(folder: &Path) -> Check {
    let (topic, name) = ("disk", folder.display());
    if !is_writable(folder) {
        return Check::problem(topic, format!("{name} is not writable"), "choose another folder by --out");
    }
    let remedy = "free some space, or record less (trundle run --help, recording)";
    match free_bytes(folder) {
        None => Check::warning(topic, format!("the free space of {name} is unknown"), "check it by df -h"),
        Some(bytes) if bytes < MIN_FREE_BYTES => {
            let min = MIN_FREE_BYTES / 1_000_000;
            Check::problem(
                topic,
                format!("{} MB are free at {name}, expected {min} MB", bytes / 1_000_000),
                remedy,
            )
        }
        Some(bytes) if bytes < LOW_FREE_BYTES => Check::warning(
            topic,
            format!("{} MB are free at {name}, half an hour of images at most", bytes / 1_000_000),
            remedy,
        ),
        Some(bytes) => Check::ok(topic, format!("{} GB are free at {name}", bytes / 1_000_000_000)),
    }
}

#[cfg(unix)]
fn is_writable(folder: &Path) -> bool {
    rustix::fs::access(folder, rustix::fs::Access::WRITE_OK).is_ok()
}

#[cfg(not(unix))]
fn is_writable(folder: &Path) -> bool {
    std::fs::metadata(folder).is_ok_and(|data| !data.permissions().readonly())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;

    #[test]
    #[cfg(target_os = "linux")]
    fn folders_to_come_are_checked_by_their_parent() {
        let place = tempfile::tempdir().unwrap();
        let checks = check(&place.path().join("a/b"));
        assert!(
            checks[0].finding.ends_with(&place.path().display().to_string())
                || checks[0].level != CheckLevel::Ok
        );
        let refused = check(Path::new("/proc/no-such-folder"));
        assert_eq!(refused[0].level, CheckLevel::Problem, "{refused:?}");
    }
}
