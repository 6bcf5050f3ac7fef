//! Specification of a library before loading.

use crate::camera::CameraError;
use std::fmt;

/// A library of a camera maker, before it is loaded.
#[derive(Debug, Clone, Copy)]
pub struct LibrarySpec {
    /// Name in messages.
    pub name: &'static str,
    /// Environment variable with the file of the library.
    pub variable: &'static str,
    /// Names for the loader, in order of preference.
    pub sonames: &'static [&'static str],
    /// Path inside a Python wheel; `None` without a wheel.
    pub wheel: Option<WheelFile>,
    /// First version that suits.
    pub from: LibraryVersion,
    /// First version above the supported ones.
    pub below: LibraryVersion,
    /// Remedy for a missing library, with the exact command.
    pub remedy: &'static str,
}

/// Place of a library inside a Python wheel.
#[derive(Debug, Clone, Copy)]
pub struct WheelFile {
    /// Folder below `site-packages`.
    pub folder: &'static str,
    /// First characters of the file name.
    pub prefix: &'static str,
}

/// Version of a library.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct LibraryVersion {
    /// Changes that break callers.
    pub major: u32,
    /// Additions.
    pub minor: u32,
    /// Corrections.
    pub patch: u32,
}

impl LibraryVersion {
    /// A version from its three numbers.
    pub const fn new(major: u32, minor: u32, patch: u32) -> Self {
        Self { major, minor, patch }
    }

    /// From one number of two decimal digits for each part, as 25901 for 2.59.1.
    pub fn from_decimal(number: u32) -> Self {
        Self::new(number / 10_000, number / 100 % 100, number % 100)
    }
}

impl fmt::Display for LibraryVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

impl LibrarySpec {
    /// The versions that suit, in words.
    pub fn expected(&self) -> String {
        format!("{} or newer, below {}", self.from, self.below)
    }

    /// Passes a version that suits through.
    ///
    /// # Errors
    /// [`CameraError::VersionUnsuitable`] otherwise.
    pub fn check(&self, found: LibraryVersion) -> Result<LibraryVersion, CameraError> {
        if (self.from..self.below).contains(&found) {
            Ok(found)
        } else {
            Err(self.unsuitable(found.to_string()))
        }
    }

    pub(super) fn unsuitable(&self, found: String) -> CameraError {
        CameraError::VersionUnsuitable { name: self.name.into(), found, expected: self.expected() }
    }
}
