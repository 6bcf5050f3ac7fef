//! Events that arrive out of order, put in the order of their stamps.

use std::collections::BTreeMap;
use trundle_core::Stamp;

/// A buffer that delays each event, which allows events with earlier stamps to overtake it.
///
/// The buffer yields events in the order of their stamps, and events of one stamp in the order of their arrival.
#[derive(Debug, Clone)]
pub struct ReorderBuffer<T> {
    hold_s: f64,
    max_events: usize,
    /// Events by stamp and number of arrival.
    events: BTreeMap<(Stamp, u64), T>,
    arrivals: u64,
    last: Option<Stamp>,
    dropped: u64,
}

impl<T> ReorderBuffer<T> {
    /// A buffer that stores events until `hold_s` (s, 0 or above) after their stamps, and at most `max_events`.
    pub fn new(hold_s: f64, max_events: usize) -> Self {
        Self { hold_s, max_events, events: BTreeMap::new(), arrivals: 0, last: None, dropped: 0 }
    }

    /// Adds an event. Returns false for a stamp before an event already delivered; the event is dropped and counted.
    pub fn push(&mut self, stamp: Stamp, event: T) -> bool {
        if self.last.is_some_and(|last| stamp < last) {
            self.dropped += 1;
            return false;
        }
        self.events.insert((stamp, self.arrivals), event);
        self.arrivals += 1;
        true
    }

    /// The next event in order whose time is over at `now`, or that is beyond the number of events held.
    pub fn pop(&mut self, now: Stamp) -> Option<(Stamp, T)> {
        let (stamp, _) = *self.events.first_key_value()?.0;
        (now - stamp >= self.hold_s || self.events.len() > self.max_events).then(|| self.take_first())?
    }

    /// The next event in order, however young it is. For the end of the stream.
    pub fn pop_any(&mut self) -> Option<(Stamp, T)> {
        self.take_first()
    }

    /// Stamp at which the next event's time is over; `None` for an empty buffer.
    pub fn next_due(&self) -> Option<Stamp> {
        self.events.first_key_value().map(|((stamp, _), _)| stamp.after(self.hold_s))
    }

    /// Events that came too late and were dropped.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    fn take_first(&mut self) -> Option<(Stamp, T)> {
        let ((stamp, _), event) = self.events.pop_first()?;
        self.last = Some(stamp);
        Some((stamp, event))
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
        std::iter::from_fn(|| buffer.pop(at(now))).map(|(_, event)| event).collect()
    }

    #[test]
    fn events_wait_for_earlier_ones_and_later_ones_are_dropped() {
        let mut buffer = ReorderBuffer::new(0.05, 10);
        assert!(buffer.push(at(100), 'b') && buffer.push(at(80), 'a') && buffer.push(at(100), 'c'));
        assert_eq!(buffer.next_due(), Some(at(130)));
        assert_eq!(popped(&mut buffer, 129), "");
        assert_eq!(popped(&mut buffer, 130), "a");
        assert!(buffer.push(at(90), 'd'));
        assert_eq!(popped(&mut buffer, 150), "dbc");
        assert!(!buffer.push(at(99), 'e') && buffer.push(at(100), 'f'));
        assert_eq!((popped(&mut buffer, 150).as_str(), buffer.dropped()), ("f", 1));
    }

    #[test]
    fn the_number_of_events_is_bounded() {
        let mut buffer = ReorderBuffer::new(1.0, 2);
        for (i, event) in "abcd".chars().enumerate() {
            buffer.push(at(i as i64), event);
        }
        assert_eq!(popped(&mut buffer, 3), "ab");
        assert_eq!((buffer.pop_any(), buffer.pop_any()), (Some((at(2), 'c')), Some((at(3), 'd'))));
    }

    proptest! {
        #[test]
        fn the_output_is_in_order_and_complete(
            stamps in prop::collection::vec(0i64..2000, 0..200), hold_ms in 0i64..500, max in 0usize..20,
        ) {
            let mut buffer = ReorderBuffer::new(hold_ms as f64 * 1e-3, max);
            let (mut out, mut now) = (Vec::new(), 0);
            for stamp in &stamps {
                now = now.max(*stamp);
                buffer.push(at(*stamp), ());
                out.extend(std::iter::from_fn(|| buffer.pop(at(now))).map(|(stamp, ())| stamp));
                prop_assert!(buffer.events.len() <= max);
            }
            out.extend(std::iter::from_fn(|| buffer.pop_any()).map(|(stamp, ())| stamp));
            prop_assert!(out.is_sorted());
            prop_assert_eq!(out.len() as u64 + buffer.dropped(), stamps.len() as u64);
        }
    }
}
