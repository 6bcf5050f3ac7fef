//! The processor time of the calling thread.

use std::time::Duration;

/// Processor time of this thread, without the time of other threads.
#[cfg(unix)]
pub fn now() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// The clock of the thread, or wall-clock time if threads have no clock.
#[cfg(not(unix))]
pub fn now() -> Duration {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_never_goes_back() {
        let before = super::now();
        assert!(super::now() >= before);
    }
}
