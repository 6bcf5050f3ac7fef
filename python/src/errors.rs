//! Errors of the crates as Python exceptions with the same messages.

use pyo3::PyErr;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyPermissionError, PyRuntimeError, PyValueError};
use std::fmt::Display;
use std::io::ErrorKind;
use trundle::app::AppError;
use trundle::io::IoError;

/// `ValueError` for an invalid value.
pub fn value_error(problem: impl Display) -> PyErr {
    PyValueError::new_err(problem.to_string())
}

/// `OSError` if the system refuses a file, `ValueError` for invalid content.
pub fn io_error(error: IoError) -> PyErr {
    let text = error.to_string();
    match error {
        IoError::System { source, .. } => match source.kind() {
            ErrorKind::NotFound => PyFileNotFoundError::new_err(text),
            ErrorKind::PermissionDenied => PyPermissionError::new_err(text),
            _ => PyOSError::new_err(text),
        },
        IoError::Incomplete { .. } => PyOSError::new_err(text),
        _ => PyValueError::new_err(text),
    }
}

/// As [`io_error`] for files, `RuntimeError` if the system refuses, else `ValueError`.
pub fn app_error(error: AppError) -> PyErr {
    match error {
        AppError::Io(error) => io_error(error),
        AppError::Environment(problem) => PyRuntimeError::new_err(problem),
        other => value_error(other),
    }
}
