//! A wrapping millisecond counter, converted to the time since its first value.

use trundle_core::Stamp;

/// Values of the counter: 65536. Source: the Kobuki's stamps have 16 bits.
const COUNTER_VALUES_MS: i64 = 1 << 16;
/// Nanoseconds of a millisecond. Source: SI.
const NANOS_PER_MS: i64 = 1_000_000;

/// Unwraps a 16-bit counter of milliseconds.
///
/// Among all times that match a value, the nearest to the host's elapsed time is used. A silence of any length is bridged if the clocks
/// differ by less than 32 s over it.
#[derive(Debug, Clone, Copy, Default)]
pub struct MillisUnwrapper {
    /// Unwrapped time and arrival of the last value.
    last: Option<(i64, Stamp)>,
}

impl MillisUnwrapper {
    /// Device time of a counter value that arrived at `arrival` (host's clock): ns, the first one below 65536 ms.
    pub fn unwrap(&mut self, value_ms: u16, arrival: Stamp) -> i64 {
        let value = i64::from(value_ms);
        let millis = match self.last {
            None => value,
            Some((last, then)) => {
                let expected = last + (arrival.nanos.saturating_sub(then.nanos)) / NANOS_PER_MS;
                let half = COUNTER_VALUES_MS / 2;
                expected + (value - expected + half).rem_euclid(COUNTER_VALUES_MS) - half
            }
        };
        self.last = Some((millis, arrival));
        millis * NANOS_PER_MS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * NANOS_PER_MS)
    }

    #[test]
    fn a_wrap_and_a_long_silence_are_bridged() {
        let mut unwrapper = MillisUnwrapper::default();
        assert_eq!(unwrapper.unwrap(65_530, at(100)), 65_530 * NANOS_PER_MS);
        assert_eq!(unwrapper.unwrap(14, at(180)), 65_550 * NANOS_PER_MS);
        assert_eq!(unwrapper.unwrap(4, at(180)), 65_540 * NANOS_PER_MS, "a step back of 10 ms");
        let silence = 10 * COUNTER_VALUES_MS + 500;
        assert_eq!(unwrapper.unwrap(480, at(180 + silence)), (65_540 + silence - 24) * NANOS_PER_MS);
    }

    #[test]
    fn a_restart_of_the_device_is_a_jump() {
        let mut unwrapper = MillisUnwrapper::default();
        unwrapper.unwrap(20_000, at(0));
        assert_eq!(unwrapper.unwrap(0, at(20)), 0);
    }
}
