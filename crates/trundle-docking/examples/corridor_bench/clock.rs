//! Time on a machine that may be busy with other things: the least of several runs.

use std::time::Instant;

/// Runs are repeated while one takes less than this, ms.
const SHORT: f64 = 300.0;

/// The result of `work` and the least time of up to three runs, ms.
pub fn timed<T>(mut work: impl FnMut() -> T) -> (T, f64) {
    let mut run = || {
        let start = Instant::now();
        let result = work();
        (result, start.elapsed().as_secs_f64() * 1e3)
    };
    let (result, mut least) = run();
    for _ in 0..2 {
        if least < SHORT {
            least = least.min(run().1);
        }
    }
    (result, least)
}
