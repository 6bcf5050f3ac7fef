//! Display of a running experiment for a front end: a line of progress, and one run at a time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use trundle_app::Progress;
use trundle_app::operator::{EndedRun, FrontEnd, Operator, OperatorLink, SeriesView};

/// Display of an experiment for a front end. Clones share the display.
#[derive(Debug, Clone, Default)]
pub struct ExperimentDisplay {
    progress: Progress,
    stage: Option<Arc<Stage>>,
}

/// Display of one of the parallel runs.
#[derive(Debug)]
struct Stage {
    operator: Operator,
    is_taken: AtomicBool,
    series: Mutex<SeriesView>,
}

/// A run of an experiment. The run is displayed until it is dropped, if no other run is.
#[derive(Debug)]
pub struct StagedRun<'d> {
    display: &'d ExperimentDisplay,
    is_on_stage: bool,
    name: String,
}

/// The result of a run for a front end.
pub trait RunResult {
    /// Whether the run succeeded.
    fn is_success(&self) -> bool;

    /// The result in a sentence.
    fn sentence(&self) -> String;
}

impl From<Progress> for ExperimentDisplay {
    fn from(progress: Progress) -> Self {
        Self { progress, stage: None }
    }
}

impl ExperimentDisplay {
    /// A display with a line of progress, which shows runs to the viewers of `operator`.
    #[must_use]
    pub fn with_stage(progress: Progress, operator: Operator) -> Self {
        let stage = Stage { operator, is_taken: AtomicBool::new(false), series: Mutex::default() };
        Self { progress, stage: Some(Arc::new(stage)) }
    }

    /// The line of progress.
    #[must_use]
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Begins a series of runs; `unit` is the plural name of a run, as "worlds".
    pub fn begin(&self, total: usize, unit: &'static str) {
        self.change(|series| {
            let number = series.number;
            *series = SeriesView { unit, total: Some(total), number, ..SeriesView::default() };
        });
    }

    /// Begins a run, which is displayed if no other run is.
    #[must_use]
    pub fn enter(&self, name: String) -> StagedRun<'_> {
        let is_on_stage =
            self.stage.as_ref().is_some_and(|stage| !stage.is_taken.swap(true, Ordering::Relaxed));
        if is_on_stage {
            self.change(|series| {
                series.number += 1;
                series.shown.clone_from(&name);
            });
        }
        StagedRun { display: self, is_on_stage, name }
    }

    fn change(&self, change: impl FnOnce(&mut SeriesView)) {
        if let Some(stage) = &self.stage {
            let mut series = stage.series();
            change(&mut series);
            stage.operator.show_series(series.clone());
        }
    }
}

impl Stage {
    fn series(&self) -> MutexGuard<'_, SeriesView> {
        self.series.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl StagedRun<'_> {
    /// The run's link to viewers; `None` for a run that is not displayed.
    #[must_use]
    pub fn link(&self) -> Option<OperatorLink> {
        let stage = self.display.stage.as_ref().filter(|_| self.is_on_stage)?;
        Some(stage.operator.link_of_shown_run())
    }

    /// The companions of a run, without a line of progress.
    #[must_use]
    pub fn front_end(&self, progress: Progress) -> FrontEnd {
        FrontEnd { progress, operator: self.link() }
    }

    /// Shows the result of the run.
    pub fn end(&self, result: &dyn RunResult) {
        let ended =
            || EndedRun { name: self.name.clone(), is_success: result.is_success(), text: result.sentence() };
        self.display.change(|series| {
            series.done += 1;
            Arc::make_mut(&mut series.ended).push(ended());
        });
    }
}

impl Drop for StagedRun<'_> {
    fn drop(&mut self) {
        if let (true, Some(stage)) = (self.is_on_stage, &self.display.stage) {
            stage.is_taken.store(false, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
pub(crate) mod fixtures {
    //! A result for tests of runs.

    use super::RunResult;

    impl RunResult for u32 {
        fn is_success(&self) -> bool {
            self.is_multiple_of(2)
        }

        fn sentence(&self) -> String {
            self.to_string()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::operator_link;

    #[test]
    fn one_run_is_on_the_stage_and_all_results_are_shown() {
        let (operator, _link) = operator_link();
        let display = ExperimentDisplay::with_stage(Progress::hidden(), operator.clone());
        display.begin(3, "runs");
        let first = display.enter("first".to_owned());
        let second = display.enter("second".to_owned());
        assert!(first.link().is_some() && second.link().is_none());
        second.end(&7);
        drop(first);
        let third = display.enter("third".to_owned());
        assert!(third.link().is_some());
        let series = operator.series().unwrap();
        assert_eq!(
            (series.done, series.total, series.number, series.shown.as_str()),
            (1, Some(3), 2, "third")
        );
        let ended = EndedRun { name: "second".to_owned(), is_success: false, text: "7".to_owned() };
        assert_eq!(*series.ended, [ended]);
    }

    #[test]
    fn without_a_stage_nothing_is_shown() {
        let display = ExperimentDisplay::from(Progress::hidden());
        display.begin(1, "runs");
        assert!(display.enter("only".to_owned()).link().is_none());
    }
}
