//! Placement of a thread: core, niceness, real-time rank.

use std::time::Duration;

/// Cores and priority of a thread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ThreadPlacement {
    /// The processor core, from 0; `None` for any core.
    pub core: Option<usize>,
    /// Niceness above that of the starting thread, 0 to 39. Default 0.
    pub nice: i32,
    /// Whether the thread has a real-time priority (Linux: `SCHED_FIFO`), above all other threads of any niceness, if the system allows it.
    /// Only for threads with little computation. Default false.
    pub is_first: bool,
}

impl ThreadPlacement {
    /// Applies the placement to the calling thread. Returns whether the system granted everything. On systems other than Linux nothing is
    /// granted.
    pub fn take(self) -> bool {
        let pinned = self.core.is_none_or(pin);
        let ranked = self.nice == 0 || rank(self.nice);
        let is_first = !self.is_first || go_first();
        pinned && ranked && is_first
    }
}

#[cfg(target_os = "linux")]
fn pin(core: usize) -> bool {
    use rustix::thread::{CpuSet, sched_setaffinity};
    let mut set = CpuSet::new();
    if core >= CpuSet::MAX_CPU {
        return false;
    }
    set.set(core);
    sched_setaffinity(None, &set).is_ok()
}

/// Linux has niceness per thread; id 0 is the calling thread.
#[cfg(target_os = "linux")]
fn rank(nicer: i32) -> bool {
    use rustix::process::{getpriority_process, setpriority_process};
    getpriority_process(None).and_then(|now| setpriority_process(None, now + nicer)).is_ok()
}

/// Real-time priority, 1 to 99: below the kernel's own threads. Source: ours.
#[cfg(target_os = "linux")]
const THREAD_PRIORITY: i32 = 10;

#[cfg(target_os = "linux")]
fn go_first() -> bool {
    let rank = libc::sched_param { sched_priority: THREAD_PRIORITY };
    // Threads started by such a thread do not inherit its priority.
    let policy = libc::SCHED_FIFO | libc::SCHED_RESET_ON_FORK;
    // SAFETY: the call reads one valid structure and changes only the scheduling of the calling thread (0).
    unsafe { libc::sched_setscheduler(0, policy, &rank) == 0 }
}

#[cfg(not(target_os = "linux"))]
fn go_first() -> bool {
    false
}

#[cfg(not(target_os = "linux"))]
fn pin(_core: usize) -> bool {
    false
}

#[cfg(not(target_os = "linux"))]
fn rank(_nice: i32) -> bool {
    false
}

/// Processor time of the calling thread. `None` if the system has no clock per thread.
#[cfg(unix)]
pub fn thread_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).ok()?))
}

/// Processor time of the calling thread. `None` if the system has no clock per thread.
#[cfg(not(unix))]
pub fn thread_time() -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_thread_can_be_pinned_and_made_nicer() {
        let place = ThreadPlacement { core: Some(0), nice: 5, is_first: false };
        assert!(std::thread::spawn(move || place.take()).join().unwrap());
        let nowhere = ThreadPlacement { core: Some(100_000), ..ThreadPlacement::default() };
        assert!(!std::thread::spawn(move || nowhere.take()).join().unwrap());
    }

    #[cfg(unix)]
    #[test]
    fn the_clock_of_a_thread_never_goes_back() {
        let before = thread_time().unwrap();
        assert!(thread_time().unwrap() >= before);
    }
}
