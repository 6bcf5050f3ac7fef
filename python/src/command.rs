//! The command line of the program `trundle`.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line of these arguments, the program's name first. Returns the exit code for the process.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| trundle_cli::run(arguments))
}
