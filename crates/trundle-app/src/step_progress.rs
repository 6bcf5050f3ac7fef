//! Progress of a command, step by step, for a front end.

/// Shows the number of finished steps. The implementation of `()` shows no progress.
pub trait StepProgress {
    /// Starts the display; `steps` is the number of steps, `None` if unknown.
    fn begin(&self, steps: Option<usize>);
    /// Counts one more finished step.
    fn advance(&self);
    /// Shows a line next to the count.
    fn message(&self, line: &str);
    /// Runs `work`, which may log, while the display is hidden.
    fn pause(&self, work: &dyn Fn());
    /// The work is done: the display is cleared.
    fn end(&self);
}

impl StepProgress for () {
    fn begin(&self, _steps: Option<usize>) {}

    fn advance(&self) {}

    fn message(&self, _line: &str) {}

    fn pause(&self, work: &dyn Fn()) {
        work();
    }

    fn end(&self) {}
}
