//! Stamps.

use crate::generated::builtin_interfaces::{Duration, Time};
use crate::generated::std_msgs::Header;
use trundle_core::{Invalid, Stamp};

/// Nanoseconds of a second. Source: SI.
const NANOS_PER_S: i64 = 1_000_000_000;

/// The stamp on its sender's clock.
///
/// # Errors
/// When the nanoseconds are not below a second.
pub fn from_ros(time: &Time) -> Result<Stamp, Invalid> {
    if i64::from(time.nanosec) >= NANOS_PER_S {
        return Err(Invalid::new("stamp.nanosec", time.nanosec, "ns", "0 to 999999999"));
    }
    Ok(Stamp::from_nanos(i64::from(time.sec) * NANOS_PER_S + i64::from(time.nanosec)))
}

/// The stamp as a message; what does not fit into 32 bits of seconds (after 2038) is the largest that does.
#[must_use]
pub fn to_ros(stamp: Stamp) -> Time {
    let sec = i32::try_from(stamp.nanos.div_euclid(NANOS_PER_S)).unwrap_or(i32::MAX);
    Time { sec, nanosec: stamp.nanos.rem_euclid(NANOS_PER_S) as u32 }
}

/// A duration of `seconds` \[s\].
#[must_use]
pub fn duration(seconds: f64) -> Duration {
    let Time { sec, nanosec } = to_ros(Stamp::default().after(seconds));
    Duration { sec, nanosec }
}

/// Seconds of a duration \[s\].
#[must_use]
pub fn seconds(duration: &Duration) -> f64 {
    f64::from(duration.sec) + f64::from(duration.nanosec) * 1e-9
}

/// A header of `stamp` in `frame`.
#[must_use]
pub fn header(stamp: Stamp, frame: &str) -> Header {
    Header { stamp: to_ros(stamp), frame_id: frame.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_go_there_and_back() {
        for nanos in [0, 1, 1_790_000_000_123_456_789, -1] {
            let stamp = Stamp::from_nanos(nanos);
            assert_eq!(from_ros(&to_ros(stamp)).unwrap(), stamp);
        }
        assert!(from_ros(&Time { sec: 0, nanosec: 1_000_000_000 }).is_err());
        assert_eq!(to_ros(Stamp::from_nanos(i64::MAX)).sec, i32::MAX);
        assert!((seconds(&duration(1.25)) - 1.25).abs() < 1e-9);
    }
}
