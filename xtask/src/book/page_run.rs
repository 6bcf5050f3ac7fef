//! One page's commands in an empty folder.

use super::script;
use crate::program;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Stands for any number of lines in an expected output.
const ELLIPSIS: &str = "...";

/// The state of a page: its folder, and what the last script printed.
pub struct PageRun {
    root: PathBuf,
    page: String,
    folder: PathBuf,
    path: OsString,
    output: String,
}

impl PageRun {
    /// A page that begins in an empty folder, with the program `trundle` first in the path.
    pub fn new(root: &Path, trundle: &Path, page: &str) -> Result<Self, String> {
        let folder = program::scratch(root, &format!("book-commands/{}", page.replace(['/', ':'], "-")))?;
        let own = trundle.parent().map(Path::to_path_buf).unwrap_or_default();
        let path = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths([own].into_iter().chain(std::env::split_paths(&path)))
            .map_err(|e| format!("{}: {e}", trundle.display()))?;
        Ok(Self { root: root.to_path_buf(), page: page.to_owned(), folder, path, output: String::new() })
    }

    /// Runs a script up to its first failing command, with the page's folder as home. The inner error is the end with the output.
    pub fn script(&mut self, text: &str) -> Result<Result<(), String>, String> {
        let mut shell = Command::new("sh");
        shell.current_dir(&self.folder).env("HOME", &self.folder);
        self.run(shell, text)
    }

    /// Runs a script as [`PageRun::script`], in the folder of the sources and with the user's home: cargo finds its packages there.
    pub fn script_in_clone(&mut self, text: &str) -> Result<Result<(), String>, String> {
        let mut shell = Command::new("sh");
        shell.current_dir(&self.root);
        self.run(shell, text)
    }

    fn run(&mut self, mut shell: Command, text: &str) -> Result<Result<(), String>, String> {
        let start = Instant::now();
        shell.args(["-e", "-u", "-c", text]).env("PATH", &self.path);
        let end = script::run(shell)?;
        self.output = end.output;
        let seconds = start.elapsed().as_secs_f64();
        println!("{seconds:8.1} s  {}: {}", self.page, text.lines().next().unwrap_or(""));
        Ok(end.failure.map_or(Ok(()), |why| Err(format!("{why}; the output:\n{}", self.output))))
    }

    /// Compares expected lines with the last output: the output has them in this order. Widths of blanks do not count.
    pub fn compare(&self, expected: &str) -> Result<(), String> {
        let mut lines = self.output.lines().map(single_blanks);
        let expected =
            expected.lines().map(single_blanks).filter(|line| !line.is_empty() && line != ELLIPSIS);
        for line in expected {
            if !lines.any(|found| found == line) {
                return Err(format!("the output has no line {line:?} there:\n{}", self.output));
            }
        }
        Ok(())
    }
}

fn single_blanks(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}
