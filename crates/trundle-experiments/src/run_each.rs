//! Parallel runs of an experiment, until all are done or the user interrupts.

use crate::experiment_display::{ExperimentDisplay, RunResult};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use trundle_app::operator::OperatorLink;
use trundle_app::{AppError, stop};

/// Executes the runs in parallel, one per thread; the results are in the order of the plans. After an interrupt, the results are those of
/// the finished runs. `unit`: the plural name of a run, as "worlds"; `name_of`: its name on the display.
///
/// # Errors
/// The first plan that cannot be carried out; [`AppError::Stopped`] if no run is done.
pub fn run_each<P: Send, T: Send + RunResult>(
    plans: Vec<P>,
    unit: &'static str,
    display: &ExperimentDisplay,
    name_of: impl Fn(&P) -> String + Sync,
    run: impl Fn(P, Option<OperatorLink>) -> Result<T, AppError> + Sync,
) -> Result<Vec<T>, AppError> {
    let (done, total) = (AtomicUsize::new(0), plans.len());
    display.begin(total, unit);
    let count = || format!("{} of {total} {unit}", done.load(Ordering::Relaxed));
    let results = plans.into_par_iter().map(|plan| {
        if stop::is_requested(count) {
            return Ok(None);
        }
        let staged = display.enter(name_of(&plan));
        let result = run(plan, staged.link());
        if stop::is_requested(count) {
            return Ok(None); // the run may have been broken off
        }
        done.fetch_add(1, Ordering::Relaxed);
        result.iter().for_each(|result| staged.end(result));
        display.progress().show_count(done.load(Ordering::Relaxed), total, unit);
        result.map(Some)
    });
    let results: Vec<T> = results.collect::<Result<Vec<_>, AppError>>()?.into_iter().flatten().collect();
    if results.is_empty() && total > 0 { Err(AppError::Stopped) } else { Ok(results) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_plans_and_the_first_refusal_is_told() {
        let double = |n: u32, _| if n < 9 { Ok(2 * n) } else { Err(AppError::Input(n.to_string())) };
        let run = |plans| run_each(plans, "runs", &ExperimentDisplay::default(), u32::to_string, double);
        assert_eq!(run(vec![3, 1, 2]).unwrap(), [6, 2, 4]);
        assert_eq!(run(vec![1, 9]).unwrap_err().to_string(), "9");
    }
}
