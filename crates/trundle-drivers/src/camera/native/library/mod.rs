//! Libraries of camera makers, loaded at run time.
//!
//! The program links none of the libraries: without a library, only its cameras are unavailable. A library is searched in this order:
//!
//! 1. the file in the settings;
//! 2. the file in the environment variable of the library, as `TRUNDLE_REALSENSE_LIB`;
//! 3. the default path of the loader, by its sonames;
//! 4. well-known folders of Debian, ROS and local builds;
//! 5. the Python wheels in the folders of `TRUNDLE_PYTHON_WHEELS`; the word `python3` means the folders of that program.
//!
//! A file given in the settings or by a variable is the only candidate. It may be a list separated by `:`. All but the last are loaded
//! first, with their symbols visible to the last.
//!
//! | module | content |
//! |---|---|
//! | [`spec`] | specification of a library before loading |
//! | [`search`] | the files to try |
//! | [`native_library`] | a loaded library |
//! | [`report`] | whether a library is usable, for the user |
//! | `functions` | a table of the library's functions |
//! | `wheel` | libraries inside Python wheels |

mod candidate;
pub(in crate::camera) mod functions;
pub mod native_library;
pub mod report;
pub mod search;
pub mod spec;
mod wheel;

pub use native_library::NativeLibrary;
pub use report::{LibraryReport, LibraryState};
pub use spec::{LibrarySpec, LibraryVersion, WheelFile};
