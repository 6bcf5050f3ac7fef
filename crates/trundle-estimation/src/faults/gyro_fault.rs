//! Detection of a gyro whose output is frozen.

use trundle_core::GyroRate;

/// Separates a gyro with a frozen output from one at rest.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct GyroFault {
    last: Option<GyroRate>,
    /// Time since the output last changed, s.
    unchanged_for: f64,
    /// Whether the output contradicted the wheels and has not changed since.
    is_frozen: bool,
}

/// Time of equal readings after which a gyro may be frozen, s. Noise changes the output of a working gyro. Source: ours.
const MAX_UNCHANGED_S: f64 = 0.3;
/// Difference of the turn rates by gyro and wheels that proves a frozen gyro, rad/s. Source: ours.
const MAX_RATE_DIFFERENCE_RAD_S: f64 = 0.1;

impl GyroFault {
    /// Adds a reading.
    pub(crate) fn add(&mut self, rate: &GyroRate) {
        self.unchanged_for = match self.last {
            Some(last) if last.omega == rate.omega => self.unchanged_for + (rate.stamp - last.stamp),
            _ => {
                self.is_frozen = false;
                0.0
            }
        };
        self.last = Some(*rate);
    }

    /// Whether the output has been unchanged long enough for a frozen gyro.
    pub(crate) fn is_suspect(&self) -> bool {
        self.unchanged_for > MAX_UNCHANGED_S
    }

    /// Whether the gyro is frozen, at a turn rate by the wheels of `by_wheels` rad/s and a bias of `bias` rad/s. A frozen gyro is reported
    /// until its output changes, since slow turns do not contradict it.
    pub(crate) fn contradicts(&mut self, by_wheels: f64, bias: f64) -> bool {
        let differs = |last: GyroRate| (last.omega - bias - by_wheels).abs() > MAX_RATE_DIFFERENCE_RAD_S;
        self.is_frozen |= self.is_suspect() && self.last.is_some_and(differs);
        self.is_frozen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Stamp;

    #[test]
    fn only_a_gyro_that_contradicts_the_wheels_is_frozen() {
        let mut gyro = GyroFault::default();
        for i in 0..100 {
            gyro.add(&GyroRate { stamp: Stamp::from_nanos(i * 20_000_000), omega: 0.02 });
        }
        assert!(!gyro.contradicts(0.0, 0.02), "a quiet gyro at rest");
        assert!(gyro.contradicts(0.8, 0.02));
        assert!(gyro.contradicts(0.05, 0.02), "a slow turn does not clear the fault");
        gyro.add(&GyroRate { stamp: Stamp::from_nanos(2_000_000_000), omega: 0.03 });
        assert!(!gyro.contradicts(0.8, 0.02), "the output has changed");
    }
}
