use trundle_core::{GyroRate, Stamp};

/// The integral of the gyro's rate, read off at the wheels' times.
///
/// A reading is the mean rate since the one before it: a gyro's output filter passes half its own rate of readings, and trapezoids over
/// such means would lag by half a period (a degree when a turn of 100 deg/s begins). After the newest reading its rate is held, and what
/// that was wrong by is made good with the next one.
#[derive(Debug, Clone, Default)]
pub(crate) struct TurnIntegral {
    newest: Option<GyroRate>,
    /// Integral up to the newest reading, rad, bias in it.
    angle: f64,
    /// What was read off last: up to when, and the angle there.
    read: Option<(Stamp, f64)>,
}

impl TurnIntegral {
    /// Takes in a reading. One that is not newer than the last is refused (`false`); after a gap longer than `timeout` s
    /// the integral begins anew.
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

    /// The turn since the last time it was read off, rad, with how long that was, s; `None` when the gyro does not cover
    /// that time.
    pub(crate) fn turn_until(&mut self, stamp: Stamp, timeout: f64) -> Option<(f64, f64)> {
        let newest = self.newest.filter(|newest| (stamp - newest.stamp).abs() <= timeout)?;
        let angle = self.angle + newest.omega * (stamp - newest.stamp);
        let last = self.read.replace((stamp, angle));
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
    fn a_changing_rate_is_integrated_whatever_the_order_of_the_readings() {
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
            // The integral of 0.5 t dt over 2 s, rad; late readings cost the first 40 ms, and the last 20 ms are held.
            assert!((sum - 1.0).abs() < if gyro_first { 1e-12 } else { 6e-4 }, "{sum}");
        }
    }

    #[test]
    fn a_gyro_that_falls_silent_is_no_gyro() {
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
