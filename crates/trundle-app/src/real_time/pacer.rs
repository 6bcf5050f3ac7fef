//! Delays a simulation to the wall clock.

use std::time::{Duration, Instant};

/// Lag above which a simulation does not catch up and its time continues from there \[s\]. Source: ours.
const MAX_CATCH_UP_S: f64 = 0.25;

/// Delays a simulation to the wall clock.
#[derive(Debug)]
pub struct RealTimePacer {
    /// When the simulated time was, or would have been, 0.
    origin: Instant,
}

impl RealTimePacer {
    /// A pacer that starts at simulated time 0.
    pub fn start() -> Self {
        Self::start_at(Instant::now())
    }

    /// Simulated time was 0 at `origin`.
    pub fn start_at(origin: Instant) -> Self {
        Self { origin }
    }

    /// Waits until `time` s have passed since the start; how late it is already, s.
    pub fn wait_for(&mut self, time: f64) -> f64 {
        let ahead = time - self.origin.elapsed().as_secs_f64();
        if ahead > 0.0 {
            std::thread::sleep(Duration::from_secs_f64(ahead));
        } else if ahead < -MAX_CATCH_UP_S {
            self.origin += Duration::from_secs_f64(-ahead);
        }
        (-ahead).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_waits_when_ahead_and_forgets_when_behind() {
        let start = Instant::now();
        let mut pace = RealTimePacer::start();
        pace.wait_for(0.05);
        assert!(start.elapsed().as_secs_f64() >= 0.05);
        std::thread::sleep(Duration::from_secs_f64(MAX_CATCH_UP_S + 0.06));
        pace.wait_for(0.05); // 0.31 s late: simulated time goes on from here
        let again = Instant::now();
        pace.wait_for(0.08);
        assert!(again.elapsed().as_secs_f64() > 0.02);
    }
}
