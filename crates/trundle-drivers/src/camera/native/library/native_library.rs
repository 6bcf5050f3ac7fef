//! A loaded library.

use super::candidate::Candidate;
use super::search::candidates;
use super::{LibrarySpec, LibraryVersion};
use crate::camera::CameraError;
use libloading::os::unix::{Library, RTLD_GLOBAL, RTLD_LOCAL, RTLD_NOW};
use std::ffi::{CStr, c_int};
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};

/// A loaded library of a camera manufacturer. It is never unloaded: these libraries start threads and register exit handlers that do not
/// survive unloading.
#[derive(Debug)]
pub struct NativeLibrary {
    spec: LibrarySpec,
    file: PathBuf,
    library: ManuallyDrop<Library>,
}

impl NativeLibrary {
    /// Loads the library `spec`; `setting` is its file in the settings, if given.
    ///
    /// # Errors
    /// [`CameraError::LibraryMissing`] when the file does not exist; [`CameraError::LibraryBroken`] when the file, or a library that it
    /// requires, cannot be loaded.
    pub fn load(spec: LibrarySpec, setting: Option<&Path>) -> Result<Self, CameraError> {
        let candidates = candidates(&spec, setting);
        let mut problems = Vec::new();
        for candidate in candidates.files {
            match open(&candidate) {
                Ok(library) => {
                    return Ok(Self { spec, file: candidate.file, library: ManuallyDrop::new(library) });
                }
                Err(problem) => problems.push((candidate.file, problem)),
            }
        }
        Err(failure(&spec, candidates.named_by, problems))
    }

    /// Specification of the library.
    pub fn spec(&self) -> &LibrarySpec {
        &self.spec
    }

    /// Returns the version `found` if it is supported.
    ///
    /// # Errors
    /// [`CameraError::VersionUnsuitable`] otherwise.
    pub fn check_version(&self, found: LibraryVersion) -> Result<LibraryVersion, CameraError> {
        self.spec.check(found)
    }

    /// The function `name`, `None` if the library lacks it.
    ///
    /// # Safety
    /// `T` must be the type of a pointer to that function, according to its documentation.
    pub unsafe fn function<T: Copy>(&self, name: &str) -> Option<T> {
        // SAFETY: the caller vouches for the type.
        unsafe { self.library.get::<T>(name.as_bytes()) }.ok().map(|symbol| *symbol)
    }

    /// The error of a library without the functions `names`.
    pub fn lacks(&self, names: &[&str]) -> CameraError {
        self.spec.unsuitable(format!("unknown (without the functions {})", names.join(", ")))
    }

    /// Path of the file that contains the address of a function; the requested file if the loader does not report it.
    pub fn path_of(&self, function: *const ()) -> PathBuf {
        // SAFETY: all fields of the structure may be zero.
        let mut found: libc::Dl_info = unsafe { std::mem::zeroed() };
        // SAFETY: the loader compares the address and writes into the structure.
        let is_found = unsafe { libc::dladdr(function.cast(), &mut found) } != 0;
        if !is_found || found.dli_fname.is_null() {
            return self.file.clone();
        }
        // SAFETY: a name from the loader ends with a zero and lives as long as the library, which is never unloaded.
        let name = unsafe { CStr::from_ptr(found.dli_fname) };
        PathBuf::from(name.to_string_lossy().into_owned())
    }
}

fn open(candidate: &Candidate) -> Result<Library, String> {
    for file in &candidate.preloaded {
        let _never_unloaded = ManuallyDrop::new(open_file(file, RTLD_GLOBAL)?);
    }
    open_file(&candidate.file, RTLD_LOCAL)
}

fn open_file(file: &Path, visibility: c_int) -> Result<Library, String> {
    // SAFETY: loading runs the initialisers of a library that the user installed or named for this purpose.
    unsafe { Library::open(Some(file), RTLD_NOW | visibility) }.map_err(|error| {
        std::error::Error::source(&error).map_or_else(|| error.to_string(), ToString::to_string)
    })
}

fn failure(spec: &LibrarySpec, named_by: Option<String>, problems: Vec<(PathBuf, String)>) -> CameraError {
    let name = spec.name.to_owned();
    let is_absent = |(file, problem): &&(PathBuf, String)| {
        problem.starts_with(&format!("{}: cannot open shared object file", file.display()))
    };
    match problems.iter().find(|entry| named_by.is_some() || !is_absent(entry)) {
        Some((file, problem)) => {
            let named = named_by.map(|by| format!(", named by {by}")).unwrap_or_default();
            let remedy = remedy_of(spec, problem);
            CameraError::LibraryBroken {
                name,
                file: format!("{}{named}", file.display()),
                problem: problem.clone(),
                remedy,
            }
        }
        None => CameraError::LibraryMissing { name, remedy: spec.remedy.to_owned() },
    }
}

/// Remedy for a message of the loader. It begins with the missing file, if one is missing.
fn remedy_of(spec: &LibrarySpec, problem: &str) -> String {
    let missing = problem.split(": cannot open shared object file").next().filter(|name| *name != problem);
    match missing {
        Some("libusb-1.0.so.0") => "run 'sudo apt install libusb-1.0-0'".into(),
        Some("libjpeg.so.62") => "run 'sudo apt install libjpeg62-turbo'".into(),
        Some(name) if name.starts_with("libpython") => {
            let package = name.split(".so").next().unwrap_or(name);
            format!("run 'sudo apt install {package}'")
        }
        _ => spec.remedy.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_dependency_is_named_with_its_package() {
        let problem = "libpython3.11.so.1.0: cannot open shared object file: No such file or directory";
        let remedy = remedy_of(&crate::camera::native::realsense::LIBRARY, problem);
        assert_eq!(remedy, "run 'sudo apt install libpython3.11'");
    }
}
