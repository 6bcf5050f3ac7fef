//! Events that arrive out of order, put in the order of their stamps.

use std::collections::BTreeMap;
use trundle_core::Stamp;

/// Time without an event out of order after which events are no longer held \[s\]. Source: ours; Wi-Fi roams and scans every few seconds.
const QUIET_S: f64 = 10.0;
/// Step back of a stamp that is another time of the device's clock, not a late event \[s\]. Source: ours; far above any bound on the hold.
const CLOCK_JUMP_S: f64 = 1.0;

/// Puts events in order, and holds them only as long as their disorder needs.
///
/// Problem: events of one transport with jitter, or of several transports, arrive out of the order of their stamps. To hold each event for
/// the largest delay would slow down the control of a base whose events arrive in order. Idea: the hold is the age of the oldest event that
/// a newer one has overtaken in the last 10 s, at most `max_hold_s`; while events arrive in order, it is 0. An event is yielded when the hold
/// is over since its stamp, or since its arrival if its stamp is ahead. An event before one that was yielded is late and dropped. A step back
/// of over 1 s is a clock that was set: the order begins anew. Cost: O(log n) per event.
#[derive(Debug, Clone)]
pub struct ReorderBuffer<T> {
    max_hold_s: f64,
    max_events: usize,
    /// Events by stamp and number of arrival, with the begin of their hold.
    events: BTreeMap<(Stamp, u64), (Stamp, T)>,
    arrivals: u64,
    /// Stamp of the newest event that arrived.
    newest: Option<Stamp>,
    /// Stamp of the last event that was yielded.
    last: Option<Stamp>,
    hold_s: f64,
    /// Arrival of the last event out of order.
    disorder: Option<Stamp>,
    counts: ReorderCounts,
}

/// Number of events out of order.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ReorderCounts {
    /// Events that a newer one had overtaken, put in order.
    pub reordered: u64,
    /// Events that arrived after a newer one was yielded, and were dropped.
    pub late: u64,
}

impl<T> ReorderBuffer<T> {
    /// A buffer that holds events for at most `max_hold_s` (s, 0 or above), and at most `max_events`.
    #[must_use]
    pub fn new(max_hold_s: f64, max_events: usize) -> Self {
        Self {
            max_hold_s,
            max_events,
            events: BTreeMap::new(),
            arrivals: 0,
            newest: None,
            last: None,
            hold_s: 0.0,
            disorder: None,
            counts: ReorderCounts::default(),
        }
    }

    /// Adds an event that arrives at `now`. Returns false for a late event, which is dropped.
    pub fn push(&mut self, stamp: Stamp, now: Stamp, event: T) -> bool {
        if self.newest.is_some_and(|newest| newest - stamp > CLOCK_JUMP_S) {
            (self.newest, self.last) = (None, None);
        }
        let is_late = self.last.is_some_and(|last| stamp < last);
        if self.newest.is_some_and(|newest| stamp < newest) {
            self.widen(now - stamp, now);
            self.counts.late += u64::from(is_late);
            self.counts.reordered += u64::from(!is_late);
        }
        if is_late {
            return false;
        }
        self.newest = self.newest.max(Some(stamp));
        self.events.insert((stamp, self.arrivals), (stamp.min(now), event));
        self.arrivals += 1;
        true
    }

    /// The next event in order whose hold is over at `now`, or that is beyond the number of events held.
    pub fn pop(&mut self, now: Stamp) -> Option<T> {
        if self.disorder.is_some_and(|disorder| now - disorder > QUIET_S) {
            (self.hold_s, self.disorder) = (0.0, None);
        }
        let (_, (since, _)) = self.events.first_key_value()?;
        if now - *since < self.hold_s && self.events.len() <= self.max_events {
            return None;
        }
        let ((stamp, _), (_, event)) = self.events.pop_first()?;
        self.last = Some(stamp);
        Some(event)
    }

    /// Whether no event is held.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Number of events out of order so far.
    #[must_use]
    pub fn counts(&self) -> ReorderCounts {
        self.counts
    }

    /// Holds events long enough for one of this age \[s\].
    fn widen(&mut self, age: f64, now: Stamp) {
        self.hold_s = self.hold_s.max(age).clamp(0.0, self.max_hold_s);
        self.disorder = Some(now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    fn popped(buffer: &mut ReorderBuffer<char>, now: i64) -> String {
        std::iter::from_fn(|| buffer.pop(at(now))).collect()
    }

    #[test]
    fn events_in_order_are_not_held() {
        let mut buffer = ReorderBuffer::new(0.1, 10);
        for (i, event) in "abc".chars().enumerate() {
            let now = 20 * i as i64;
            // The stamp of the last one is ahead of the clock.
            assert!(buffer.push(at(now - 15 + 30 * i64::from(event == 'c')), at(now), event));
            assert_eq!(popped(&mut buffer, now), event.to_string());
        }
        assert_eq!(buffer.counts(), ReorderCounts::default());
    }

    #[test]
    fn after_a_late_event_the_next_ones_are_held_for_its_age() {
        let mut buffer = ReorderBuffer::new(0.1, 10);
        buffer.push(at(100), at(100), 'a');
        assert_eq!(popped(&mut buffer, 100), "a");
        assert!(!buffer.push(at(90), at(130), 'b'), "late by 10 ms, 40 ms old");
        assert!(buffer.push(at(140), at(140), 'd') && buffer.push(at(120), at(150), 'c'));
        assert_eq!(popped(&mut buffer, 159), "");
        assert_eq!(popped(&mut buffer, 160), "c");
        assert_eq!(popped(&mut buffer, 179), "");
        assert_eq!(popped(&mut buffer, 180), "d");
        assert_eq!(buffer.counts(), ReorderCounts { reordered: 1, late: 1 });
        assert!(buffer.is_empty());
    }

    #[test]
    fn the_hold_is_bounded_and_ends_after_quiet() {
        let mut buffer = ReorderBuffer::new(0.1, 10);
        buffer.push(at(1000), at(1000), 'a');
        assert_eq!(popped(&mut buffer, 1000), "a");
        assert!(!buffer.push(at(500), at(1000), 'b'));
        buffer.push(at(1020), at(1020), 'c');
        assert_eq!((popped(&mut buffer, 1119), popped(&mut buffer, 1120)), (String::new(), "c".to_owned()));
        buffer.push(at(11_100), at(11_100), 'd');
        assert_eq!(popped(&mut buffer, 11_100), "d", "10 s without an event out of order");
    }

    #[test]
    fn a_clock_that_is_set_back_begins_the_order_anew() {
        let mut buffer = ReorderBuffer::new(0.1, 10);
        buffer.push(at(50_000), at(50_000), 'a');
        assert_eq!(popped(&mut buffer, 50_000), "a");
        assert!(buffer.push(at(10), at(10), 'b'));
        assert_eq!(popped(&mut buffer, 10), "b");
        assert_eq!(buffer.counts(), ReorderCounts::default());
    }

    #[test]
    fn the_number_of_events_is_bounded() {
        let mut buffer = ReorderBuffer::new(1.0, 2);
        buffer.push(at(500), at(500), 'x');
        assert_eq!(popped(&mut buffer, 500), "x");
        assert!(!buffer.push(at(0), at(500), 'y'));
        for (i, event) in "abcd".chars().enumerate() {
            buffer.push(at(510 + i as i64), at(510 + i as i64), event);
        }
        assert_eq!(popped(&mut buffer, 513), "ab");
    }

    proptest! {
        #[test]
        fn the_output_is_in_order_and_complete(
            delays in prop::collection::vec(0i64..400, 0..200), hold_ms in 0i64..500, max in 0usize..20,
        ) {
            let mut buffer = ReorderBuffer::new(hold_ms as f64 * 1e-3, max);
            let mut arrivals: Vec<(i64, i64)> =
                delays.iter().enumerate().map(|(i, delay)| (i as i64 * 10 + delay, i as i64 * 10)).collect();
            arrivals.sort_unstable();
            let (mut out, mut end) = (Vec::new(), 0);
            for (arrival, stamp) in arrivals {
                buffer.push(at(stamp), at(arrival), stamp);
                out.extend(std::iter::from_fn(|| buffer.pop(at(arrival))));
                prop_assert!(buffer.events.len() <= max);
                end = arrival;
            }
            out.extend(std::iter::from_fn(|| buffer.pop(at(end + 1000))));
            prop_assert!(out.is_sorted());
            prop_assert_eq!(out.len() as u64 + buffer.counts().late, delays.len() as u64);
        }
    }
}
