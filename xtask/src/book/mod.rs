//! The book: docs as HTML by mdbook, its links, and the commands that its pages show.

pub mod build;
mod commands;
mod html_links;
mod interrupted;
mod page_run;
pub mod repository_links;
mod script;

use crate::workspace::Verdict;
use crate::{command_reference, program};
use std::path::Path;

/// Checks the reference of commands, runs the tested commands of the pages, then builds the book and checks its links.
pub fn run(root: &Path) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let is_reference_new = command_reference::run(root, &trundle, true)?;
    let do_commands_pass = commands::run(root, &trundle)?;
    Ok(build::run(root)? && do_commands_pass && is_reference_new)
}
