//! The files to try for a library.

use super::candidate::Candidate;
use super::{LibrarySpec, wheel};
use std::path::{Path, PathBuf};

/// Folders of libraries outside the loader's default path. Source: file lists of the Debian, ROS 2 and librealsense packages.
const WELL_KNOWN_FOLDERS: &[&str] = &[
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/local/lib",
    "/opt/ros/jazzy/lib/x86_64-linux-gnu",
    "/opt/ros/jazzy/lib/aarch64-linux-gnu",
    "/opt/ros/humble/lib/x86_64-linux-gnu",
    "/opt/ros/humble/lib/aarch64-linux-gnu",
];

/// The files to try for a library, first to last.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidates {
    /// Source of the file's name; `None` if the default places are tried.
    pub named_by: Option<String>,
    /// The files.
    pub files: Vec<Candidate>,
}

/// The files to try for `spec`; `setting` is the file in the settings.
pub fn candidates(spec: &LibrarySpec, setting: Option<&Path>) -> Candidates {
    let variable = || std::env::var_os(spec.variable).map(PathBuf::from);
    let named = setting.map(|file| ("the settings".to_owned(), file.to_path_buf()));
    match named.or_else(|| variable().map(|file| (spec.variable.to_owned(), file))) {
        Some((by, files)) => {
            Candidates { named_by: Some(by), files: named_file(&files).into_iter().collect() }
        }
        None => Candidates { named_by: None, files: default_files(spec) },
    }
}

/// The last file of a list separated by `:`. The other files are loaded before it.
fn named_file(files: &Path) -> Option<Candidate> {
    let mut files: Vec<PathBuf> = std::env::split_paths(files).collect();
    let file = files.pop()?;
    Some(Candidate { preloaded: files, file })
}

fn default_files(spec: &LibrarySpec) -> Vec<Candidate> {
    let alone = |file: PathBuf| Candidate { preloaded: Vec::new(), file };
    let by_loader = spec.sonames.iter().map(|soname| alone(soname.into()));
    let folders = WELL_KNOWN_FOLDERS.iter().map(Path::new);
    let by_folder =
        folders.flat_map(|folder| spec.sonames.iter().map(move |soname| alone(folder.join(soname))));
    let existing = by_folder.filter(|candidate| candidate.file.exists());
    by_loader.chain(existing).chain(wheel::candidates(spec)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_of_a_list_is_the_library() {
        let found = named_file(Path::new("libusb-1.0.so.0:/opt/librealsense2.so")).unwrap();
        assert_eq!(found.preloaded, [PathBuf::from("libusb-1.0.so.0")]);
        assert_eq!(found.file, PathBuf::from("/opt/librealsense2.so"));
    }
}
