//! Ends the process when an input takes too long.

use rustix::time::{ClockId, clock_gettime};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;

/// Processor time of an input \[ms\]: an input that takes more is a hang. Source: ours.
const MAX_INPUT_MS: u64 = 1000;
/// Exit code of a process that hung. Source: ours.
pub const HANG_CODE: i32 = 97;
/// Period of checks of the clock. Source: ours.
const WATCH_PERIOD: Duration = Duration::from_millis(50);
/// No input is read.
const NO_INPUT: u64 = u64::MAX;

/// Processor time at which the input began \[ms\].
static BEGAN_MS: AtomicU64 = AtomicU64::new(NO_INPUT);

/// Starts the thread that watches.
pub fn start() {
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(WATCH_PERIOD);
            let began = BEGAN_MS.load(Relaxed);
            if began != NO_INPUT && processor_ms() > began + MAX_INPUT_MS {
                std::process::exit(HANG_CODE);
            }
        }
    });
}

/// An input begins.
pub fn begin() {
    BEGAN_MS.store(processor_ms(), Relaxed);
}

/// The input is over.
pub fn end() {
    BEGAN_MS.store(NO_INPUT, Relaxed);
}

/// Processor time of the process: the clock on the wall would count the time of other programs.
fn processor_ms() -> u64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    u64::try_from(time.tv_sec * 1000 + time.tv_nsec / 1_000_000).unwrap_or(0)
}
