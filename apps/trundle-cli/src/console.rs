//! Output on the terminal: results, tables, errors, progress. The only module of the program that prints.
#![expect(clippy::print_stderr, reason = "errors go to standard error")]

use std::io::Write;
use trundle::app::{AppError, Progress, StepProgress};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Prints the reason of a failure on standard error.
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

/// The progress of work in steps: a bar where their number is known, else a spinner.
pub struct StepDisplay {
    bar: ProgressBar,
}

impl StepDisplay {
    /// A display that appears when the work begins; none where `quiet`.
    pub fn new(quiet: bool) -> Self {
        Self { bar: hidden_if(quiet, ProgressBar::new_spinner()) }
    }
}

impl StepProgress for StepDisplay {
    fn begin(&self, steps: Option<usize>) {
        self.bar.reset();
        let template = match steps {
            Some(steps) => {
                self.bar.set_length(steps as u64);
                "{bar:30} {pos}/{len} frames  {per_sec}  ETA {eta}  {msg}"
            }
            None => SPINNER,
        };
        self.bar.set_style(style(template));
    }

    fn advance(&self) {
        self.bar.inc(1);
    }

    fn message(&self, line: &str) {
        self.bar.set_message(line.to_owned());
    }

    fn pause(&self, work: &dyn Fn()) {
        self.bar.suspend(work);
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// The template of a spinner with a message.
const SPINNER: &str = "{spinner} {msg}";

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("invariant: the template is valid")
}

/// A spinner with a message.
fn live_line(quiet: bool) -> ProgressBar {
    hidden_if(quiet, ProgressBar::new_spinner().with_style(style(SPINNER)))
}

fn hidden_if(quiet: bool, bar: ProgressBar) -> ProgressBar {
    if quiet {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar
}
