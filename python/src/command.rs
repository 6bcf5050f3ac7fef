//! The command line, as the program `trundle` has it.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command line of these arguments, the program's name first. Returns the exit code; the process should end with it.
#[pyfunction]
pub fn run_command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| trundle_cli::run(arguments))
}
