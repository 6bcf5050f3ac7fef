//! The processor's time of this thread, if the system reports it: a busy machine does not count.
#![allow(dead_code, reason = "benchmarks print times, tests have limits")]

use std::time::Instant;

/// The result of `work` and its time, ms.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let (wall, before) = (Instant::now(), on_processor_ns());
    let result = work();
    let wall_ms = wall.elapsed().as_secs_f64() * 1e3;
    let ms = before.zip(on_processor_ns()).map_or(wall_ms, |(before, after)| (after - before) * 1e-6);
    (result, ms.min(wall_ms))
}

/// Linux: nanoseconds on the processor. The kernel counts when it is asked to schedule, hence the yield.
fn on_processor_ns() -> Option<f64> {
    std::thread::yield_now();
    std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split_whitespace().next()?.parse().ok()
}

/// Time of [`reference_work`] on the machine that the limits of time are for \[ms\]. Source: measured there, 2 cores of an AMD EPYC.
const REFERENCE_MS: f64 = 7.0;
/// Number of runs of the reference, of which the fastest counts. Source: ours.
const REFERENCE_RUNS: usize = 5;

/// How many times longer than the reference machine this one takes at the moment, at least 1: limits of time grow by it.
pub fn slowness() -> f64 {
    let runs = (0..REFERENCE_RUNS).map(|_| timed(reference_work).1);
    (runs.fold(f64::INFINITY, f64::min) / REFERENCE_MS).max(1.0)
}

/// Nearest of ten thousand points to each of a thousand others: arithmetic over memory, as in a search among obstacles.
fn reference_work() -> f64 {
    let points: Vec<(f64, f64)> =
        (0..10_000).map(|i| (f64::from(i).sin() * 3.0, f64::from(i).cos() * 3.0)).collect();
    let nearest = |at: f64| {
        let squares = points.iter().map(|(x, y)| (x - at).powi(2) + (y + at).powi(2));
        squares.fold(f64::INFINITY, f64::min)
    };
    std::hint::black_box((0..1_000).map(|i| nearest(f64::from(i) * 0.01).sqrt()).sum())
}
