use trundle_core::GyroRate;

/// Tells a gyro that says the same again and again, whatever the wheels do, from one at rest.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StuckGyro {
    last: Option<GyroRate>,
    same_for: f64,
    /// It contradicted the wheels, and has said nothing else since.
    is_stuck: bool,
}

/// A gyro whose readings were all the same for so long may be stuck, s: in motion noise alone makes them differ.
const SUSPECT: f64 = 0.3;
/// And is, when the wheels turn the robot at a rate so far from it, rad/s.
const APART: f64 = 0.1;

impl StuckGyro {
    /// Notes a reading.
    pub(crate) fn note(&mut self, rate: &GyroRate) {
        self.same_for = match self.last {
            Some(last) if last.omega == rate.omega => self.same_for + (rate.stamp - last.stamp),
            _ => {
                self.is_stuck = false;
                0.0
            }
        };
        self.last = Some(*rate);
    }

    /// Whether it has said the same for so long that it may be stuck.
    pub(crate) fn is_suspect(&self) -> bool {
        self.same_for > SUSPECT
    }

    /// Whether the gyro is stuck, where the wheels say `by_wheels` rad/s and its bias is `bias` rad/s.
    /// Once it was, it is until it says something else: slow turns would not show it.
    pub(crate) fn contradicts(&mut self, by_wheels: f64, bias: f64) -> bool {
        let apart = |last: GyroRate| (last.omega - bias - by_wheels).abs() > APART;
        self.is_stuck |= self.is_suspect() && self.last.is_some_and(apart);
        self.is_stuck
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Stamp;

    #[test]
    fn only_one_that_does_not_follow_the_wheels_is_stuck() {
        let mut gyro = StuckGyro::default();
        for i in 0..100 {
            gyro.note(&GyroRate { stamp: Stamp::from_nanos(i * 20_000_000), omega: 0.02 });
        }
        assert!(!gyro.contradicts(0.0, 0.02), "a quiet gyro at rest");
        assert!(gyro.contradicts(0.8, 0.02));
        assert!(gyro.contradicts(0.05, 0.02), "a slow turn does not make it whole");
        gyro.note(&GyroRate { stamp: Stamp::from_nanos(2_000_000_000), omega: 0.03 });
        assert!(!gyro.contradicts(0.8, 0.02), "it speaks again");
    }
}
