//! Time stamps in the form of the Foxglove schemas.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Stamp};

/// A stamp as Foxglove writes it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Time {
    pub sec: i64,
    pub nsec: u32,
}

impl From<Stamp> for Time {
    fn from(stamp: Stamp) -> Self {
        let nsec = stamp.nanos.rem_euclid(1_000_000_000) as u32; // below 1e9 by rem_euclid
        Self { sec: stamp.nanos.div_euclid(1_000_000_000), nsec }
    }
}

impl TryFrom<Time> for Stamp {
    type Error = Invalid;

    fn try_from(time: Time) -> Result<Self, Invalid> {
        let nanos = time.sec.checked_mul(1_000_000_000).and_then(|n| n.checked_add(i64::from(time.nsec)));
        let nanos = nanos.filter(|_| time.nsec < 1_000_000_000);
        let invalid =
            || Invalid::new("time", format!("{} s + {} ns", time.sec, time.nsec), "", "nsec below 1e9");
        nanos.map(Self::from_nanos).ok_or_else(invalid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_time_is_its_stamp(nanos in any::<i64>()) {
            let stamp = Stamp::from_nanos(nanos);
            prop_assert_eq!(Stamp::try_from(Time::from(stamp)).ok(), Some(stamp));
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let refused = |sec, nsec| Stamp::try_from(Time { sec, nsec }).is_err();
        assert!(refused(0, 1_000_000_000) && refused(i64::MAX, 0));
    }
}
