//! Waits between two attempts.

use std::time::Duration;

/// First wait. Source: ours.
const FIRST_WAIT: Duration = Duration::from_secs(1);
/// Longest wait. Source: ours; a broker's machine starts in less.
const LONGEST_WAIT: Duration = Duration::from_secs(30);

/// Waits between two attempts: each twice the last.
#[derive(Debug)]
pub struct BackOff {
    wait: Duration,
}

impl Default for BackOff {
    fn default() -> Self {
        Self { wait: FIRST_WAIT }
    }
}

impl BackOff {
    /// The wait before the next attempt.
    pub fn next_wait(&mut self) -> Duration {
        let wait = self.wait;
        self.wait = (2 * wait).min(LONGEST_WAIT);
        wait
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waits_grow_up_to_a_limit() {
        let mut back_off = BackOff::default();
        let waits: Vec<u64> = (0..7).map(|_| back_off.next_wait().as_secs()).collect();
        assert_eq!(waits, [1, 2, 4, 8, 16, 30, 30]);
    }
}
