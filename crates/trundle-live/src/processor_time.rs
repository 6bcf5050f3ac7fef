//! Processor time of the program.

use std::sync::LazyLock;
use std::time::Instant;

/// Time since the first call, by a clock that never jumps \[s\].
pub fn clock_s() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Processor time of all threads of the program so far \[s\]; `None` if the system does not report it.
#[cfg(unix)]
pub fn processor_time_s() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// Processor time of all threads of the program so far \[s\]; `None` if the system does not report it.
#[cfg(not(unix))]
pub fn processor_time_s() -> Option<f64> {
    None
}

#[cfg(all(test, unix))]
mod tests {
    use super::processor_time_s;

    #[test]
    fn it_grows_with_work() {
        let before = processor_time_s().unwrap();
        let start = std::time::Instant::now();
        while processor_time_s().unwrap() < before + 0.01 {
            assert!(start.elapsed().as_secs() < 60);
        }
    }
}
