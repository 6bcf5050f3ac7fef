//! Where a front end shows how much of its work a command has done, step by step.

/// Shows how many of a known number of steps are done. `()` shows nothing.
pub trait StepProgress {
    /// The work begins; `steps` of them, if the number is known.
    fn begin(&self, steps: Option<usize>);
    /// One more step is done.
    fn advance(&self);
    /// Shows a line beside the count.
    fn message(&self, line: &str);
    /// Runs `work`, which may log, while nothing is shown.
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
