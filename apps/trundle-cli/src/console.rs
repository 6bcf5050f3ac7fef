//! Output on the terminal: results, tables, errors, progress. The only module of the program that prints.
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::sync::OnceLock;
use trundle::app::{AppError, Progress, StepProgress, aligned_table, step_line};

/// The first refusal of standard output.
static PRINT_FAILURE: OnceLock<std::io::Error> = OnceLock::new();

/// Prints the reason of a failure on standard error.
pub fn print_error(error: &AppError) {
    print_on_stderr(format_args!("trundle: {error}"));
}

/// Prints on standard error that a signal has ended the command, and the written results.
pub fn print_stopped(signal: &str, what: &str) {
    print_on_stderr(format_args!("trundle: stopped by {signal}{what}"));
}

/// Prints a line on standard error. A standard error without a reader does not affect the run; `eprintln!` would panic.
fn print_on_stderr(line: std::fmt::Arguments) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Logs a warning, which the terminal shows; the run continues.
pub fn warn(message: &str) {
    tracing::warn!("{message}");
}

/// Prints a result on standard output.
pub fn print(text: &str) {
    let mut out = std::io::stdout();
    note_refusal(writeln!(out, "{text}").and_then(|()| out.flush()));
}

/// Prints help, the version or an error of usage; returns false if standard output refuses it.
pub fn print_usage(usage: &clap::Error) -> bool {
    note_refusal(usage.print().and_then(|()| std::io::stdout().flush()));
    usage.use_stderr() || print_failure().is_none()
}

/// Prints where a result is to be seen, if it is there: the disk may have refused it.
pub fn print_see(file: &Path) {
    if file.exists() {
        print(&format!("See {}", file.display()));
    }
}

fn note_refusal(result: std::io::Result<()>) {
    match result {
        // A closed reader is not a failure of the run.
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            PRINT_FAILURE.get_or_init(|| error);
        }
        _ => {}
    }
}

/// Error of standard output; `None` if all results were written.
pub fn print_failure() -> Option<&'static std::io::Error> {
    PRINT_FAILURE.get()
}

/// Prints a table of two columns or more on standard output, columns aligned: the first one and texts to the left, numbers to the right.
pub fn print_table(rows: &[Vec<String>]) {
    aligned_table(rows).iter().for_each(|line| print(line));
}

/// Prints the table of a result and the path of the file to look at, unless `quiet`.
pub fn print_result(quiet: bool, rows: &[Vec<String>], place: &Path) {
    if !quiet {
        print_table(rows);
        print_see(place);
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

/// The progress of work in steps: a bar if their number is known, else a spinner.
pub struct StepDisplay {
    /// Its prefix is the message of the work; its message is the whole line.
    bar: ProgressBar,
}

impl StepDisplay {
    /// A display that appears when the work begins. With `quiet` it never appears.
    pub fn new(quiet: bool) -> Self {
        Self { bar: hidden_if(quiet, ProgressBar::new_spinner()) }
    }

    /// Shows the progress and the message as one text, which the bar cuts to the width of the terminal.
    fn show(&self) {
        let (bar, eta) = (&self.bar, HumanDuration(self.bar.eta()));
        bar.set_message(step_line(bar.length(), bar.position(), &format!("{eta:#}"), &bar.prefix()));
    }
}

impl StepProgress for StepDisplay {
    fn begin(&self, steps: Option<usize>) {
        self.bar.set_style(style(if steps.is_some() { "{wide_msg}" } else { SPINNER }));
        self.bar.reset();
        self.bar.unset_length();
        steps.iter().for_each(|steps| self.bar.set_length(*steps as u64));
    }

    fn advance(&self) {
        self.bar.inc(1);
        self.show();
    }

    fn message(&self, line: &str) {
        self.bar.set_prefix(line.to_owned());
        self.show();
    }

    fn pause(&self, work: &dyn Fn()) {
        self.bar.suspend(work);
    }

    fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// The template of a spinner with a message, cut to the width of the terminal.
const SPINNER: &str = "{spinner} {wide_msg}";

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("invariant: the template is valid")
}

/// A spinner with a message.
fn live_line(quiet: bool) -> ProgressBar {
    hidden_if(quiet, ProgressBar::new_spinner().with_style(style(SPINNER)))
}

fn hidden_if(quiet: bool, bar: ProgressBar) -> ProgressBar {
    let term = std::env::var("TERM").unwrap_or_default();
    if quiet || !can_replace_a_line(std::io::stderr().is_terminal(), &term) {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar
}

/// Whether a line can be shown and replaced: on a terminal other than `TERM=dumb`.
fn can_replace_a_line(is_terminal: bool, term: &str) -> bool {
    is_terminal && term != "dumb"
}

#[cfg(test)]
mod tests {
    use super::*;
    use indicatif::TermLike;
    use std::io;
    use std::sync::{Arc, Mutex};

    /// A terminal of some width that records its lines.
    #[derive(Debug, Clone)]
    struct Screen {
        width: u16,
        drawn: Arc<Mutex<Vec<String>>>,
    }

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            self.width
        }
        fn move_cursor_up(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> io::Result<()> {
            Ok(())
        }
        fn write_line(&self, line: &str) -> io::Result<()> {
            self.write_str(line)
        }
        fn write_str(&self, text: &str) -> io::Result<()> {
            self.drawn.lock().unwrap().push(text.to_owned());
            Ok(())
        }
        fn clear_line(&self) -> io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> io::Result<()> {
            Ok(())
        }
    }

    /// The lines of work of `steps` steps, of which a hundred are done.
    fn lines(width: u16, steps: Option<usize>) -> Vec<String> {
        let screen = Screen { width, drawn: Arc::default() };
        let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
        let display = StepDisplay { bar: ProgressBar::with_draw_target(None, target) };
        display.begin(steps);
        display.message(
            &"driving to (5.03 m, 2.24 m, 90 deg), 34.2 s of 120 s, 3 images per second, no contact, "
                .repeat(3),
        );
        (0..100).for_each(|_| display.advance());
        display.bar.force_draw();
        let drawn = screen.drawn.lock().unwrap().clone();
        drawn.into_iter().filter(|text| !text.trim().is_empty()).collect()
    }

    #[test]
    fn the_line_is_one_at_any_width() {
        for width in [8, 10, 20, 40, 60, 80, 200] {
            for steps in [None, Some(400), Some(1_000_000)] {
                let lines = lines(width, steps);
                assert!(!lines.is_empty(), "{width}");
                for line in lines {
                    assert!(line.chars().count() <= usize::from(width), "{width}: {line:?}");
                }
            }
        }
        let last = lines(80, Some(400)).pop().unwrap();
        assert!(last.starts_with(" 25 %  100/400  ETA ") && last.contains("driving"), "{last}");
        assert!(lines(10, Some(400)).pop().unwrap().starts_with(" 25 %  100"));
    }

    #[test]
    fn a_line_is_replaced_only_where_the_terminal_can() {
        assert!(can_replace_a_line(true, "xterm-256color") && can_replace_a_line(true, ""));
        assert!(!can_replace_a_line(true, "dumb") && !can_replace_a_line(false, "xterm"));
    }
}
