//! Time that the processor spent on this thread, where the system tells it; a busy machine does not count.

use std::time::Instant;

/// A moment.
pub struct Clock {
    wall: Instant,
    run_ns: Option<f64>,
}

/// Now.
pub fn start() -> Clock {
    Clock { wall: Instant::now(), run_ns: run_ns() }
}

impl Clock {
    /// Milliseconds since.
    pub fn ms(&self) -> f64 {
        match (self.run_ns, run_ns()) {
            (Some(before), Some(now)) => (now - before) * 1e-6,
            _ => self.wall.elapsed().as_secs_f64() * 1e3,
        }
    }
}

/// Linux: nanoseconds on the processor.
fn run_ns() -> Option<f64> {
    std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split_whitespace().next()?.parse().ok()
}
