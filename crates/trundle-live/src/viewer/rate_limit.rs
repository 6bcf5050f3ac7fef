//! Limits the rate of a viewer's requests.

use std::time::Instant;

/// Requests per second that a viewer may send on average: ten views seen and ten twists per second, and clicks. Source: ours.
const RATE_HZ: f64 = 50.0;
/// Maximum number of requests in a burst. Source: ours; a browser page that resumes sends its waiting requests.
const BURST_REQUESTS: f64 = 150.0;

/// A bucket of permissions that fills with time.
#[derive(Debug)]
pub struct RateLimit {
    left: f64,
    filled: Instant,
}

impl RateLimit {
    /// A full bucket.
    pub fn new(now: Instant) -> Self {
        Self { left: BURST_REQUESTS, filled: now }
    }

    /// Takes one permission. Returns whether one was available.
    pub fn take(&mut self, now: Instant) -> bool {
        let seconds = now.saturating_duration_since(self.filled).as_secs_f64();
        self.left = (self.left + seconds * RATE_HZ).min(BURST_REQUESTS);
        self.filled = now;
        let is_there = self.left >= 1.0;
        if is_there {
            self.left -= 1.0;
        }
        is_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_flood_ends_and_a_usual_page_never_does() {
        let start = Instant::now();
        let mut limit = RateLimit::new(start);
        assert_eq!((0..1000).filter(|_| limit.take(start)).count(), BURST_REQUESTS as usize);
        let mut page = RateLimit::new(start);
        assert!((0..10_000).all(|i| page.take(start + Duration::from_millis(25 * i))));
    }
}
