//! The number of threads of a command.

use crate::AppError;

/// Runs `work` on a pool of this number of threads; `None`: one per core.
///
/// # Errors
/// When the system refuses a thread, and the errors of `work`.
pub fn on_threads<T: Send>(
    threads: Option<u16>,
    work: impl FnOnce() -> Result<T, AppError> + Send,
) -> Result<T, AppError> {
    let Some(threads) = threads else { return work() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build();
    pool.map_err(|error| AppError::Environment(format!("cannot start {threads} threads: {error}")))?
        .install(work)
}
