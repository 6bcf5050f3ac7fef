//! Signs that a port has two users: stamps of two bases, or bytes that another program reads.

use std::collections::VecDeque;
use std::fmt;

/// Number of the newest packets and refused headers that are compared: 50, a second of a sound stream. Source: ours.
pub(super) const WINDOW_PACKETS: usize = 50;
/// Step between the stamps of two packets below which they come from two bases: 15 ms. Source: ours; a base's step is 20 ms.
const MIN_STEP_MS: i16 = 15;
/// Number of such steps in the window that counts as a fault: 5. Source: ours; a restart of the base gives one.
const MIN_SHORT_STEPS: usize = 5;
/// Step between the stamps of two packets above which the base is slow or packets are missing: 60 ms, three periods. Source: ours.
const MAX_STEP_MS: i16 = 60;
/// Number of such steps in the window that counts as a fault: 5. Source: ours; a restart of the base gives one.
const MIN_LONG_STEPS: usize = 5;
/// Refused headers in the window that make a fault: 10. Source: ours; a sound line has none for minutes.
const MIN_REFUSED: usize = 10;

/// A fault of the stream of packets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum StreamFault {
    /// Stamps alternate between two sequences, or arrive at twice the expected rate.
    TwoSources {
        /// Steps of the stamp below 15 ms in the last second.
        short_steps: usize,
    },
    /// The stamp is constant.
    FrozenClock {
        /// Number of such packets in the last second.
        packets: usize,
    },
    /// The base sends too rarely.
    SlowBase {
        /// Steps of the stamp above 60 ms in the last 50 packets.
        long_steps: usize,
        /// The longest gap \[ms\].
        longest_ms: i16,
    },
    /// Bytes are missing or added.
    DamagedStream {
        /// Refused headers in the last second.
        refused: usize,
    },
}

impl fmt::Display for StreamFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TwoSources { short_steps } => write!(
                f,
                "the stamps of {short_steps} of {WINDOW_PACKETS} packets differ by less than {MIN_STEP_MS} ms from the one before, \
                 expected 20 ms: two bases or two programs send on this port; leave one"
            ),
            Self::FrozenClock { packets } => write!(
                f,
                "{packets} of {WINDOW_PACKETS} packets have the stamp of the one before, expected 20 ms more: the clock of the base stands \
                 still; switch the base off and on"
            ),
            Self::SlowBase { long_steps, longest_ms } => write!(
                f,
                "{long_steps} of {WINDOW_PACKETS} packets came more than {MAX_STEP_MS} ms after the one before by the base's clock, up to \
                 {longest_ms} ms, expected 20 ms (50 packets per second): the base sends too slowly, or the line loses packets; check the \
                 cable, switch the base off and on"
            ),
            Self::DamagedStream { refused } => write!(
                f,
                "{refused} of {WINDOW_PACKETS} packets are damaged: another program may read the same port (close it), \
                 or the cable is bad (change it)"
            ),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Entry {
    Sound,
    ShortStep,
    LongStep(i16),
    NoStep,
    Refused,
}

/// Reads the stamps of packets and the refused headers between.
#[derive(Debug, Clone, Default)]
pub(super) struct StreamCheck {
    last_ms: Option<u16>,
    entries: VecDeque<Entry>,
    is_faulty: bool,
    /// Times that the stream became faulty.
    faults: u64,
}

impl StreamCheck {
    /// Records the stamp of a valid packet.
    pub(super) fn on_packet(&mut self, stamp_ms: u16) {
        let step = self.last_ms.map(|last| stamp_ms.wrapping_sub(last).cast_signed());
        self.last_ms = Some(stamp_ms);
        self.push(match step {
            Some(0) => Entry::NoStep,
            Some(step) if step < MIN_STEP_MS => Entry::ShortStep,
            Some(step) if step > MAX_STEP_MS => Entry::LongStep(step),
            _ => Entry::Sound,
        });
    }

    /// Records the number of headers refused since the last call.
    pub(super) fn on_refused(&mut self, headers: u64) {
        (0..headers.min(WINDOW_PACKETS as u64)).for_each(|_| self.push(Entry::Refused));
    }

    /// The fault of the last second; `None` for a sound stream.
    pub(super) fn fault(&self) -> Option<StreamFault> {
        let count = |kind: Entry| self.entries.iter().filter(|entry| **entry == kind).count();
        let (short_steps, refused) = (count(Entry::ShortStep), count(Entry::Refused));
        let packets = count(Entry::NoStep);
        if packets >= MIN_SHORT_STEPS && short_steps < MIN_SHORT_STEPS {
            Some(StreamFault::FrozenClock { packets })
        } else if short_steps >= MIN_SHORT_STEPS {
            Some(StreamFault::TwoSources { short_steps })
        } else if refused >= MIN_REFUSED {
            Some(StreamFault::DamagedStream { refused })
        } else {
            self.slow_base()
        }
    }

    fn slow_base(&self) -> Option<StreamFault> {
        let steps = self.entries.iter().filter_map(|entry| match entry {
            Entry::LongStep(step) => Some(*step),
            _ => None,
        });
        let (long_steps, longest_ms) = (steps.clone().count(), steps.max()?);
        (long_steps >= MIN_LONG_STEPS).then_some(StreamFault::SlowBase { long_steps, longest_ms })
    }

    /// The fault if the stream was sound at the last call, and the number of faults so far.
    pub(super) fn new_fault(&mut self) -> Option<(StreamFault, u64)> {
        let fault = self.fault();
        let begins = fault.is_some() && !self.is_faulty;
        self.is_faulty = fault.is_some();
        self.faults += u64::from(begins);
        fault.filter(|_| begins).map(|fault| (fault, self.faults))
    }

    fn push(&mut self, entry: Entry) {
        if self.entries.len() == WINDOW_PACKETS {
            self.entries.pop_front();
        }
        self.entries.push_back(entry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault_of(stamps: impl Iterator<Item = u16>) -> Option<StreamFault> {
        let mut check = StreamCheck::default();
        stamps.for_each(|stamp| check.on_packet(stamp));
        check.fault()
    }

    #[test]
    fn one_base_is_sound_over_wraps_losses_and_a_restart() {
        let steady = |i: u16| i.wrapping_mul(20).wrapping_add(65_000);
        assert_eq!(fault_of((0..500).map(steady)), None);
        assert_eq!(fault_of((0..500).filter(|i| i % 3 != 0).map(steady)), None);
        assert_eq!(fault_of((0..30).map(steady).chain((0..30).map(|i| i * 20))), None);
    }

    #[test]
    fn two_bases_are_found_whatever_their_offset() {
        for offset in [1, 7, 10, 14, 500, 30_000, 60_000] {
            let both = (0..20u16).flat_map(|i| [i * 20, (i * 20).wrapping_add(offset)]);
            assert!(matches!(fault_of(both), Some(StreamFault::TwoSources { .. })), "{offset} ms");
        }
    }

    #[test]
    fn a_clock_that_stands_still_is_not_a_second_base() {
        let frozen = (0..40u16).map(|i| i.min(20) * 20);
        assert_eq!(fault_of(frozen), Some(StreamFault::FrozenClock { packets: 19 }));
    }

    #[test]
    fn a_base_of_5_hz_is_named_with_its_period() {
        let slow = fault_of((0..20u16).map(|i| i * 200));
        assert_eq!(slow, Some(StreamFault::SlowBase { long_steps: 19, longest_ms: 200 }));
        assert!(slow.unwrap().to_string().contains("up to 200 ms, expected 20 ms"));
    }

    #[test]
    fn a_fault_is_new_once_until_the_stream_was_sound() {
        let mut check = StreamCheck::default();
        for count in 1..=3 {
            check.on_refused(10);
            assert_eq!(check.new_fault(), Some((StreamFault::DamagedStream { refused: 10 }, count)));
            assert_eq!(check.new_fault(), None);
            (0..50).for_each(|i| check.on_packet(i * 20));
            assert_eq!(check.new_fault(), None);
        }
    }

    #[test]
    fn refused_headers_make_a_fault_that_ends() {
        let mut check = StreamCheck::default();
        check.on_refused(9);
        assert_eq!(check.fault(), None);
        check.on_refused(u64::MAX);
        assert_eq!(check.fault(), Some(StreamFault::DamagedStream { refused: 50 }));
        (0..45).for_each(|i| check.on_packet(i * 20));
        assert_eq!(check.fault(), None);
    }
}
