//! The gyro's angle at any stamp.

use trundle_core::{GyroRate, Stamp};

/// Integral of the gyro's rate over a recording.
///
/// A reading is the mean rate since the previous one: the integral is exact at the readings and linear between them. A gap splits the
/// integral, since the turn across it is unknown.
#[derive(Debug, Clone, Default)]
pub struct GyroAngle {
    readings: Vec<Reading>,
}

#[derive(Debug, Clone, Copy)]
struct Reading {
    stamp: Stamp,
    /// Integral up to the stamp, rad.
    angle: f64,
    /// Mean rate since the previous reading, rad/s.
    rate: f64,
    /// Number of gaps before the reading.
    gaps: usize,
}

/// Longest time between two readings that is integrated: 0.1 s. Source: default of `odometry.gyro_timeout_s`.
const MAX_GAP_S: f64 = 0.1;

impl GyroAngle {
    /// The integral of readings by rising stamp. A reading that is not newer than the last or not finite is skipped.
    #[must_use]
    pub fn new(rates: &[GyroRate]) -> Self {
        let mut readings: Vec<Reading> = Vec::with_capacity(rates.len());
        for rate in rates.iter().filter(|rate| rate.omega.is_finite()) {
            let (stamp, omega) = (rate.stamp, rate.omega);
            let next = match readings.last() {
                None => Reading { stamp, angle: 0.0, rate: omega, gaps: 0 },
                Some(last) if stamp <= last.stamp => continue,
                Some(last) if stamp - last.stamp > MAX_GAP_S => {
                    Reading { stamp, angle: last.angle, rate: omega, gaps: last.gaps + 1 }
                }
                Some(last) => {
                    let angle = last.angle + omega * (stamp - last.stamp);
                    Reading { stamp, angle, rate: omega, gaps: last.gaps }
                }
            };
            readings.push(next);
        }
        Self { readings }
    }

    /// Number of readings.
    #[must_use]
    pub fn len(&self) -> usize {
        self.readings.len()
    }

    /// Whether the integral has no reading.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.readings.is_empty()
    }

    /// Turn between two stamps, rad; `None` if the gyro does not cover the time between.
    #[must_use]
    pub fn turn(&self, from: Stamp, to: Stamp) -> Option<f64> {
        let (start, end) = (self.at(from)?, self.at(to)?);
        (start.gaps == end.gaps).then_some(end.angle - start.angle)
    }

    /// Rate at a stamp, rad/s.
    pub(super) fn rate(&self, stamp: Stamp) -> Option<f64> {
        self.at(stamp).map(|reading| reading.rate)
    }

    fn at(&self, stamp: Stamp) -> Option<Reading> {
        let after = self.readings.partition_point(|reading| reading.stamp < stamp);
        let next = *self.readings.get(after)?;
        if next.stamp == stamp {
            return Some(next);
        }
        let last = self.readings.get(after.checked_sub(1)?)?;
        (last.gaps == next.gaps).then(|| Reading {
            stamp,
            angle: next.angle - next.rate * (next.stamp - stamp),
            ..next
        })
    }
}
