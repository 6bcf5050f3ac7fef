//! The build of the book by mdbook, if it is installed.

use super::html_links;
use crate::program;
use crate::workspace::Verdict;
use std::path::Path;
use std::process::{Command, Stdio};

/// Builds the book and checks the links of its pages. Without mdbook the build is skipped.
pub fn run(root: &Path) -> Verdict {
    if Command::new("mdbook").arg("--version").output().is_err() {
        println!(
            "skipped: the build of the book, because mdbook is not installed (cargo install mdbook --locked)"
        );
        return Ok(true);
    }
    let folder = program::scratch(root, "book")?;
    let mut mdbook = Command::new("mdbook");
    mdbook.args(["build", "--dest-dir"]).arg(&folder).current_dir(root).stdin(Stdio::null());
    let status = mdbook.status().map_err(|e| format!("cannot start mdbook: {e}"))?;
    if !status.success() {
        return Ok(false);
    }
    let broken = html_links::broken(&folder)?;
    for link in &broken {
        println!("{link}");
    }
    println!("book: {} broken links, see {}", broken.len(), folder.join("index.html").display());
    Ok(broken.is_empty())
}
