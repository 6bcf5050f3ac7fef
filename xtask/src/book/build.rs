//! The build of the book by mdbook, with the references of the crates beside it, its links and its search; skipped by name without mdbook.

use super::html_links;
use crate::program::{self, answers};
use crate::workspace::Verdict;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The program that `bench/book/get-mdbook.sh` gets, below the build results.
const TOOL: &str = "book-tools/bin/mdbook";
/// The script that searches the book.
const SEARCH: &str = "bench/book/search.mjs";

/// The command that replaces links, in the environment of mdbook: it stands in `book.toml` for a build by hand. Source: mdbook, environment
/// variables.
const LINKS_COMMAND: &str = "MDBOOK_PREPROCESSOR__REPOSITORY_LINKS__COMMAND";

/// This program, which needs no further build.
fn own_command() -> Result<String, String> {
    let own = std::env::current_exe().map_err(|e| format!("the path of this program is unknown: {e}"))?;
    Ok(format!("'{}' book-links", own.display()))
}

/// Writes the reference of every crate, beside the book; warnings are errors.
pub fn references(root: &Path) -> Verdict {
    program::cargo(root, &["doc", "--workspace", "--no-deps"], &[("RUSTDOCFLAGS", "-Dwarnings")])
}

/// Builds the book, checks the links of its pages and searches in it. Without mdbook the build is skipped.
pub fn run(root: &Path) -> Verdict {
    let Some(mdbook) = mdbook(root)? else {
        println!(
            "skipped: the build of the book, because mdbook is missing (bash bench/book/get-mdbook.sh, or cargo install mdbook --locked)"
        );
        return Ok(true);
    };
    let folder = program::scratch(root, "book")?;
    if !references(root)? {
        return Ok(false);
    }
    let mut build = Command::new(&mdbook);
    build.args(["build", "--dest-dir"]).arg(&folder).current_dir(root).env(LINKS_COMMAND, own_command()?);
    if !ends_well(&mut build)? {
        return Ok(false);
    }
    let broken = html_links::broken(&folder)?;
    for link in &broken {
        println!("{link}");
    }
    println!("book: {} broken links, see {}", broken.len(), folder.join("index.html").display());
    Ok(search(root, &folder)? && broken.is_empty())
}

/// The installed mdbook, or the one of the script; `None` without both.
fn mdbook(root: &Path) -> Result<Option<PathBuf>, String> {
    let tool = program::target(root)?.join(TOOL);
    let candidates = [PathBuf::from("mdbook"), tool];
    Ok(candidates.into_iter().find(|program| answers(&program.display().to_string(), "--version")))
}

/// Whether a search for each title finds its page; skipped by name without Node.
fn search(root: &Path, folder: &Path) -> Verdict {
    if !answers("node", "--version") {
        println!("skipped: the search in the book needs node: apt-get install nodejs");
        return Ok(true);
    }
    ends_well(Command::new("node").arg(root.join(SEARCH)).arg(folder))
}

/// Whether a program ends with the exit code 0.
fn ends_well(command: &mut Command) -> Verdict {
    let status = command.stdin(Stdio::null()).status();
    let name = command.get_program().display();
    Ok(status.map_err(|e| format!("cannot start {name}: {e}"))?.success())
}
