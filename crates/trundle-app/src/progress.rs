//! Progress of a run: a line that a front end replaces each time.

use std::fmt;
use std::sync::Arc;

/// A front end's function that shows a line.
type ShowLine = dyn Fn(&str) + Send + Sync;

/// Shows one line of progress; the newest line replaces the previous one. Without a function of a front end the line is hidden.
#[derive(Clone, Default)]
pub struct Progress(Option<Arc<ShowLine>>);

impl Progress {
    /// A progress that shows no line.
    #[must_use]
    pub fn hidden() -> Self {
        Self(None)
    }

    /// Calls `show` with each line, from any thread.
    #[must_use]
    pub fn new(show: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(show)))
    }

    /// Whether the display is off: the line need not be made.
    #[must_use]
    pub fn is_hidden(&self) -> bool {
        self.0.is_none()
    }

    /// Shows the number of finished items of a known number: `3 of 12 runs, 25 %`.
    pub fn show_count(&self, done: usize, total: usize, what: &str) {
        self.show(&format!("{done} of {total} {what}, {} %", 100 * done / total.max(1)));
    }

    /// Shows a line.
    pub fn show(&self, line: &str) {
        if let Some(show) = &self.0 {
            show(line);
        }
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Progress").field(&if self.is_hidden() { "hidden" } else { "shown" }).finish()
    }
}

/// One line of work in steps: share and count of the `done` ones if their number is known, the remaining time, and the message.
#[must_use]
pub fn step_line(steps: Option<u64>, done: u64, remaining: &str, message: &str) -> String {
    match steps {
        Some(steps) => {
            format!("{:>3} %  {done}/{steps}  ETA {remaining}  {message}", 100 * done / steps.max(1))
        }
        None => message.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn each_line_reaches_the_front_end_in_order() {
        let lines = Arc::new(Mutex::new(Vec::new()));
        let sink = Arc::clone(&lines);
        let progress = Progress::new(move |line| sink.lock().unwrap().push(line.to_owned()));
        progress.show("1 of 2");
        progress.clone().show("2 of 2");
        progress.show_count(1, 3, "runs");
        assert_eq!(*lines.lock().unwrap(), ["1 of 2", "2 of 2", "1 of 3 runs, 33 %"]);
    }

    #[test]
    fn hidden_progress_asks_for_no_line() {
        assert!(Progress::hidden().is_hidden() && Progress::default().is_hidden());
        assert!(!Progress::new(|_| {}).is_hidden());
    }
}
