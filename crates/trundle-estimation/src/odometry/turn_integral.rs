//! Integral of the gyro's rate, read at the stamps of the wheels.

use trundle_core::{GyroRate, Stamp};

/// The integral of the gyro's rate, read at the stamps of the wheels.
///
/// A reading is the mean rate since the previous one, since a gyro's output filter passes half of its reading rate. Trapezoids over such
/// means would lag by half a period (one degree at the start of a turn of 100 deg/s). After the newest reading its rate is extrapolated;
/// the next reading corrects this part.
#[derive(Debug, Clone, Default)]
pub(crate) struct TurnIntegral {
    newest: Option<GyroRate>,
    /// Integral up to the newest reading, rad, with the bias.
    angle: f64,
    /// Stamp and integral of the last call of [`Self::turn_until`].
    last_read: Option<(Stamp, f64)>,
}

impl TurnIntegral {
    /// Adds a reading. A reading that is not newer than the last is rejected (`false`); a gap longer than `timeout` s restarts
    /// the integral.
    pub(crate) fn push(&mut self, rate: GyroRate, timeout: f64) -> bool {
        if !rate.omega.is_finite() {
            return false;
        }
        if let Some(newest) = self.newest {
            let dt = rate.stamp - newest.stamp;
            if dt <= 0.0 {
                return false;
            }
            if dt > timeout {
                *self = Self::default();
            } else {
                self.angle += rate.omega * dt;
            }
        }
        self.newest = Some(rate);
        true
    }

    /// The turn since the last call, rad, with its duration, s; `None` if the gyro does not cover that time.
    pub(crate) fn turn_until(&mut self, stamp: Stamp, timeout: f64) -> Option<(f64, f64)> {
        let newest = self.newest.filter(|newest| (stamp - newest.stamp).abs() <= timeout)?;
        let angle = self.angle + newest.omega * (stamp - newest.stamp);
        let last = self.last_read.replace((stamp, angle));
        last.map(|(since, start)| (angle - start, stamp - since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn the_integral_does_not_depend_on_the_order_of_wheel_and_gyro_readings() {
        for gyro_first in [true, false] {
            let mut integral = TurnIntegral::default();
            let mut sum = 0.0;
            for i in 0..=100 {
                // The mean of 0.5 t over the 20 ms before.
                let rate = GyroRate { stamp: at(i * 20), omega: 0.01 * (i as f64 - 0.5) };
                if gyro_first {
                    integral.push(rate, 0.1);
                }
                if i % 2 == 0 {
                    sum += integral.turn_until(at(i * 20), 0.1).map_or(0.0, |turn| turn.0);
                }
                if !gyro_first {
                    integral.push(rate, 0.1);
                }
            }
            // The integral of 0.5 t dt over 2 s, rad. Late readings lose the first 40 ms, and the last 20 ms are extrapolated.
            assert!((sum - 1.0).abs() < if gyro_first { 1e-12 } else { 6e-4 }, "{sum}");
        }
    }

    #[test]
    fn a_silent_gyro_yields_no_turn() {
        let mut integral = TurnIntegral::default();
        assert_eq!(integral.turn_until(at(0), 0.1), None);
        integral.push(GyroRate { stamp: at(0), omega: 1.0 }, 0.1);
        assert_eq!(integral.turn_until(at(0), 0.1), None, "the first reading only starts it");
        assert!(integral.turn_until(at(50), 0.1).is_some());
        assert_eq!(integral.turn_until(at(400), 0.1), None);
        assert!(integral.push(GyroRate { stamp: at(500), omega: 1.0 }, 0.1));
        assert!(!integral.push(GyroRate { stamp: at(490), omega: 1.0 }, 0.1), "time went back");
        assert!(!integral.push(GyroRate { stamp: at(510), omega: f64::NAN }, 0.1));
        assert_eq!(integral.turn_until(at(500), 0.1), None);
        let (turn, dt) = integral.turn_until(at(520), 0.1).unwrap();
        assert!((turn - 0.02).abs() < 1e-12 && (dt - 0.02).abs() < 1e-12);
    }
}
