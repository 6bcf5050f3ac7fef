//! Silence of topics: which topic stopped, and for how long.

use std::sync::Mutex;
use std::time::{Duration, Instant};

/// When a topic's newest message came.
#[derive(Debug)]
pub struct TopicMonitor {
    /// Full name.
    pub name: String,
    /// Type, as `sensor_msgs/msg/Image`.
    pub type_name: String,
    /// Silence after which the topic counts as stalled; `None`: it may be silent.
    limit: Option<Duration>,
    newest: Mutex<Option<Instant>>,
}

impl TopicMonitor {
    pub(super) fn new(name: String, type_name: String, limit: Option<Duration>) -> Self {
        Self { name, type_name, limit, newest: Mutex::new(None) }
    }

    /// Notes a message.
    pub(super) fn on_message(&self) {
        *self.newest() = Some(Instant::now());
    }

    /// Whether any message has come.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        self.newest().is_some()
    }

    /// The sentence of a topic that had messages and has none for too long.
    #[must_use]
    pub fn stall(&self, now: Instant) -> Option<String> {
        let (limit, newest) = (self.limit?, (*self.newest())?);
        let silence = now.saturating_duration_since(newest);
        (silence > limit).then(|| {
            let (silent, expected) = (silence.as_secs_f64(), limit.as_secs_f64());
            format!("no message for {silent:.1} s, expected one within {expected:.1} s: is its publisher alive, is the link up?")
        })
    }

    fn newest(&self) -> std::sync::MutexGuard<'_, Option<Instant>> {
        self.newest.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_topic_stalls_after_its_limit_and_not_before_its_first_message() {
        let monitor = TopicMonitor::new("/image".into(), "x".into(), Some(Duration::from_millis(500)));
        let later = Instant::now() + Duration::from_secs(2);
        assert_eq!(monitor.stall(later), None);
        monitor.on_message();
        assert_eq!(monitor.stall(Instant::now()), None);
        assert!(monitor.stall(later).unwrap().contains("expected one within 0.5 s"));
    }
}
