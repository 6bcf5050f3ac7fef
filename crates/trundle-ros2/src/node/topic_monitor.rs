//! Silence of topics: name of the stalled topic, and duration.

use crate::clock::RosClock;
use std::sync::Mutex;
use std::time::Duration;
use trundle_core::Stamp;

/// Time of a topic's newest message.
#[derive(Debug)]
pub struct TopicMonitor {
    /// Full name.
    pub name: String,
    /// Type, as `sensor_msgs/msg/Image`.
    pub type_name: String,
    /// Silence after which the topic counts as stalled; `None` for no limit.
    limit: Option<Duration>,
    /// Measures the silence. A slow simulator is not silent.
    clock: RosClock,
    newest: Mutex<Option<Stamp>>,
}

impl TopicMonitor {
    pub(super) fn new(name: String, type_name: String, limit: Option<Duration>, clock: RosClock) -> Self {
        Self { name, type_name, limit, clock, newest: Mutex::new(None) }
    }

    /// Notes a message.
    pub(super) fn on_message(&self) {
        *self.newest() = Some(self.clock.now());
    }

    /// Whether any message has come.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        self.newest().is_some()
    }

    /// The sentence of a topic that had messages and has none for too long.
    #[must_use]
    pub fn stall(&self) -> Option<String> {
        let (limit, newest) = (self.limit?.as_secs_f64(), (*self.newest())?);
        let silence = self.clock.now() - newest;
        (silence > limit).then(|| {
            format!("no message for {silence:.1} s, expected one within {limit:.1} s: is its publisher alive, is the link up?")
        })
    }

    fn newest(&self) -> std::sync::MutexGuard<'_, Option<Stamp>> {
        self.newest.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_topic_stalls_after_its_limit_of_the_clock_and_not_before_its_first_message() {
        let clock = RosClock::simulated();
        clock.set(Stamp::default()).unwrap();
        let monitor =
            TopicMonitor::new("/image".into(), "x".into(), Some(Duration::from_millis(500)), clock.clone());
        clock.set(Stamp::default().after(2.0)).unwrap();
        assert_eq!(monitor.stall(), None);
        monitor.on_message();
        clock.set(Stamp::default().after(2.4)).unwrap();
        assert_eq!(monitor.stall(), None);
        clock.set(Stamp::default().after(2.6)).unwrap();
        assert!(monitor.stall().unwrap().contains("no message for 0.6 s, expected one within 0.5 s"));
    }
}
