//! What the user sees in the terminal. The only place of the program that prints.
#![expect(clippy::print_stderr, reason = "this is the program's voice")]

use std::io::Write;
use trundle::app::{AppError, Progress};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Says why the command ended, on standard error.
pub fn print_error(error: &AppError) {
    eprintln!("trundle: {error}");
}

/// Logs a warning, which the terminal shows; the run goes on.
pub fn warn(message: &str) {
    tracing::warn!("{message}");
}

/// Prints a result on standard output.
pub fn print(text: &str) {
    // A reader that has gone away is no failure of the run.
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints a table of two columns or more on standard output, columns aligned.
pub fn print_table(rows: &[Vec<String>]) {
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
        print(format!("  {}", line.join("  ")).trim_end());
    }
}

/// A line of progress: a spinner with a message, and the progress that sets it. Clear the line when the work has ended.
pub fn progress(quiet: bool) -> (ProgressBar, Progress) {
    let line = live_line(quiet);
    if line.is_hidden() {
        return (line, Progress::hidden());
    }
    let shown = line.clone();
    let show = move |text: &str| {
        shown.set_message(text.to_owned());
        shown.tick();
    };
    (line, Progress::new(show))
}

/// A spinner with a message.
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
