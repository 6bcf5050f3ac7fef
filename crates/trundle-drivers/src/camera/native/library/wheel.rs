//! Libraries inside Python wheels.
//!
//! A wheel's extension module calls functions of Python: `libpython` has to be loaded first. The interpreter is never started.

use super::candidate::Candidate;
use super::{LibrarySpec, WheelFile};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Environment variable with the `site-packages` folders to search, separated by `:`.
const WHEELS_VARIABLE: &str = "TRUNDLE_PYTHON_WHEELS";
/// Word in [`WHEELS_VARIABLE`] for the folders of the program `python3`.
const PYTHON_WORD: &str = "python3";
/// Prints the folder of libpython, then the folders of packages.
const FOLDERS_SCRIPT: &str = "import site, sysconfig
print(sysconfig.get_config_var('LIBDIR') or '')
print(*site.getsitepackages(), site.getusersitepackages(), sep='\\n')";

/// The wheel files of `spec` in the folders of the environment variable.
pub(super) fn candidates(spec: &LibrarySpec) -> Vec<Candidate> {
    let (Some(wheel), Some(folders)) = (spec.wheel, std::env::var_os(WHEELS_VARIABLE)) else {
        return Vec::new();
    };
    std::env::split_paths(&folders)
        .flat_map(|folder| if folder == Path::new(PYTHON_WORD) { python_folders() } else { vec![folder] })
        .flat_map(|folder| files_of(&wheel, &folder))
        .map(|file| Candidate { preloaded: libpython(&file).into_iter().collect(), file })
        .collect()
}

fn python_folders() -> Vec<PathBuf> {
    let output = Command::new(PYTHON_WORD).args(["-c", FOLDERS_SCRIPT]).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().skip(1).map(PathBuf::from).collect()
}

fn files_of(wheel: &WheelFile, packages: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(packages.join(wheel.folder)).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| is_library(path, wheel.prefix)).collect();
    files.sort();
    files
}

fn is_library(path: &Path, prefix: &str) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    name.starts_with(prefix) && (name.ends_with(".so") || name.contains(".so.")) && !name.ends_with(".debug")
}

/// `libpython3.11.so.1.0` for an extension module whose name contains `.cpython-311-`.
fn libpython(module: &Path) -> Option<PathBuf> {
    let name = module.file_name()?.to_str()?;
    let digits = name.split(".cpython-").nth(1)?.split('-').next()?;
    let (major, minor) = digits.split_at_checked(1)?;
    Some(format!("libpython{major}.{minor}.so.1.0").into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libpython_follows_from_the_name_of_the_module() {
        let module = Path::new("/x/pyrealsense2.cpython-311-x86_64-linux-gnu.so");
        assert_eq!(libpython(module), Some("libpython3.11.so.1.0".into()));
        assert_eq!(libpython(Path::new("libOrbbecSDK.so.2")), None);
    }

    #[test]
    fn files_with_debug_information_are_not_libraries() {
        assert!(is_library(Path::new("libOrbbecSDK.so.2"), "libOrbbecSDK"));
        assert!(!is_library(Path::new("pyrealsense2.cpython-311.so.debug"), "pyrealsense2"));
    }
}
