//! The clock of the Kinect v1.

use trundle_core::Stamp;

/// Ticks per second \[Hz\]. The counter of 32 bits restarts every 71.6 s. Source: OpenKinect wiki, "Protocol Documentation".
const TICK_RATE_HZ: i128 = 60_000_000;
/// Nanoseconds in a second. Source: SI.
const NANOS_PER_S: i128 = 1_000_000_000;

/// A clock that continues after the counter's overflow.
#[derive(Debug, Default)]
pub(super) struct TickClock {
    last: Option<(u32, i64)>,
}

impl TickClock {
    /// Time of a number of ticks, less than half a period (35 s) from the previous one.
    pub(super) fn stamp(&mut self, ticks: u32) -> Stamp {
        let total = match self.last {
            Some((last, total)) => total + i64::from(ticks.wrapping_sub(last).cast_signed()),
            None => i64::from(ticks),
        };
        self.last = Some((ticks, total));
        Stamp::from_nanos((i128::from(total) * NANOS_PER_S / TICK_RATE_HZ) as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_goes_on_after_the_largest_number() {
        let mut clock = TickClock::default();
        let before = clock.stamp(u32::MAX - 59_999_999);
        assert!((clock.stamp(60_000_000) - before - 2.0).abs() < 1e-9);
        assert!((clock.stamp(0) - before - 1.0).abs() < 1e-9, "an image may be older than the one before");
    }
}
