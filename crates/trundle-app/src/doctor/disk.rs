//! Disk space and the right to write, of the folder that runs write to.

use super::check::Check;
use crate::free_space::{MIN_FREE_BYTES, free_bytes};
use std::path::Path;
use trundle_io::OutputFolder;

/// Free space below which a long recording does not fit \[bytes\]: half an hour of a recording. Source: `trundle run`'s announcement.
const LOW_FREE_BYTES: u64 = 10_000_000_000;

/// Name of a run in the folder, by which the folder is tried.
const ANY_RUN: &str = "run";

/// The check of the folder, or of the first of its parents that exists.
pub fn check(output: &Path) -> Vec<Check> {
    let absolute = std::path::absolute(output).unwrap_or_else(|_| output.to_owned());
    let existing = absolute.ancestors().find(|part| part.symlink_metadata().is_ok());
    vec![folder(existing.unwrap_or(Path::new("/")))]
}

fn folder(folder: &Path) -> Check {
    let (topic, name) = ("disk", folder.display());
    let other = "choose another folder by --out";
    if !folder.is_dir() {
        return Check::problem(topic, format!("{name} is not a folder, so runs cannot write there"), other);
    }
    if OutputFolder::require_writable(&folder.join(ANY_RUN)).is_err() {
        return Check::problem(topic, format!("{name} is not writable"), other);
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

    #[test]
    fn a_file_in_place_of_the_folder_is_a_problem() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("runs");
        std::fs::write(&file, "mine").unwrap();
        for output in [file.clone(), file.join("deep/er")] {
            let checks = check(&output);
            assert_eq!(checks[0].level, CheckLevel::Problem, "{checks:?}");
            assert!(checks[0].finding.contains("runs is not a folder"), "{checks:?}");
        }
    }
}
