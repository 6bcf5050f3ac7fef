//! What the user sees in the terminal. The only place of the program that prints.
#![expect(clippy::print_stderr, reason = "this is the program's voice")]

use crate::failure::Failure;
use std::io::Write;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Says why the command ended, on standard error.
pub fn complain(failure: &Failure) {
    eprintln!("trundle: {failure}");
}

/// Says something that the user should know, on standard error; the run goes on.
pub fn warn(message: &str) {
    eprintln!("trundle: warning: {message}");
}

/// Prints a result on standard output.
pub fn say(text: &str) {
    // A reader that has gone away is no failure of the run.
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints a table of two columns or more on standard output, columns aligned.
pub fn table(rows: &[Vec<String>]) {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| {
        rows.iter().filter_map(|row| row.get(c)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        let cells = row.iter().zip(&widths).enumerate();
        let line: Vec<String> = cells
            .map(|(c, (cell, &w))| if c == 0 { format!("{cell:<w$}") } else { format!("{cell:>w$}") })
            .collect();
        say(format!("  {}", line.join("  ")).trim_end());
    }
}

/// One line that lives: a spinner with a message.
pub fn live_line(quiet: bool) -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    bar.set_style(ProgressStyle::with_template("{spinner} {msg}").expect("invariant: the template is valid"));
    hidden_if(quiet, bar)
}

/// A bar with the time that is left.
pub fn bar(quiet: bool, length: usize) -> ProgressBar {
    let style = "{bar:30} {pos}/{len} frames  {per_sec}  ETA {eta}  {msg}";
    let bar = ProgressBar::new(length as u64);
    bar.set_style(ProgressStyle::with_template(style).expect("invariant: the template is valid"));
    hidden_if(quiet, bar)
}

fn hidden_if(quiet: bool, bar: ProgressBar) -> ProgressBar {
    if quiet {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar
}
