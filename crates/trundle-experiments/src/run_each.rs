//! Parallel runs of an experiment, up to the last one or an interrupt.

use crate::experiment_context::{ExperimentContext, RunSource};
use crate::experiment_display::RunResult;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use trundle_app::operator::OperatorLink;
use trundle_app::{AppError, stop};

/// Executes the runs in parallel, one per thread; the results are in the order of the plans. After an interrupt, the results are those of
/// the finished runs. `unit` is the plural name of a run, as "worlds"; `name_of` gives a run's name on the display.
///
/// # Errors
/// That of the first plan that cannot be executed; [`AppError::Stopped`] if no run is finished.
pub(crate) fn run_each<P: Send, T: Send + RunResult + Serialize + DeserializeOwned>(
    plans: Vec<P>,
    unit: &'static str,
    context: &ExperimentContext,
    name_of: impl Fn(&P) -> String + Sync,
    run: impl Fn(P, Option<OperatorLink>) -> Result<T, AppError> + Sync,
) -> Result<Vec<T>, AppError> {
    let ExperimentContext { display, runs } = context;
    let plans = runs.selected(plans, &name_of)?;
    let (done, total) = (AtomicUsize::new(0), plans.len());
    display.begin(total, unit);
    let count = || format!("{} of {total} {unit}", done.load(Ordering::Relaxed));
    let results = plans.into_par_iter().map(|plan| {
        if stop::is_requested(count) {
            return Ok(None);
        }
        let name = name_of(&plan);
        let staged = display.enter(name.clone());
        let result = runs.result(&name, || unless_it_dies(runs, &name, || run(plan, staged.link())))?;
        // The request to stop may have interrupted the run.
        let Some(result) = result.filter(|_| !stop::is_requested(count)) else { return Ok(None) };
        runs.keep(&name, &result)?;
        done.fetch_add(1, Ordering::Relaxed);
        staged.end(&result);
        display.progress().show_count(done.load(Ordering::Relaxed), total, unit);
        Ok(Some(result))
    });
    let results: Vec<T> = results.collect::<Result<Vec<_>, AppError>>()?.into_iter().flatten().collect();
    if results.is_empty() && total > 0 { Err(AppError::Stopped) } else { Ok(results) }
}

/// Executes a run. A message names a run that panics. The other runs of a shard then continue; any other experiment ends.
fn unless_it_dies<T>(
    runs: &RunSource,
    name: &str,
    run: impl FnOnce() -> Result<T, AppError>,
) -> Result<Option<T>, AppError> {
    catch_unwind(AssertUnwindSafe(run)).map_or_else(
        |panic| {
            tracing::error!("the run '{name}' has died: a fault of the program");
            if runs.goes_on_without(name) { Ok(None) } else { resume_unwind(panic) }
        },
        |result| result.map(Some),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_plans_and_the_first_refusal_is_returned() {
        let double = |n: u32, _| if n < 9 { Ok(2 * n) } else { Err(AppError::Input(n.to_string())) };
        let run = |plans| run_each(plans, "runs", &ExperimentContext::default(), u32::to_string, double);
        assert_eq!(run(vec![3, 1, 2]).unwrap(), [6, 2, 4]);
        assert_eq!(run(vec![1, 9]).unwrap_err().to_string(), "9");
    }
}
