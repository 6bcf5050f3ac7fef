//! Angles of both wheels at any stamp.

use trundle_core::{Stamp, WheelTicks};

/// Angles of both wheels since the start of a recording, linear between readings.
#[derive(Debug, Clone, Default)]
pub struct WheelAngles {
    readings: Vec<Reading>,
}

#[derive(Debug, Clone, Copy)]
struct Reading {
    stamp: Stamp,
    /// Angle of the left wheel, rad.
    left: f64,
    /// Angle of the right wheel, rad.
    right: f64,
    /// Number of gaps before the reading.
    gaps: usize,
}

/// Turns of both wheels between two stamps.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WheelTurn {
    /// Turn of the left wheel, rad, forward positive.
    pub(super) left: f64,
    /// Turn of the right wheel, rad, forward positive.
    pub(super) right: f64,
}

/// Longest time between two readings: 0.5 s. Counters may wrap in a longer time. Source: default of `odometry.max_gap_s`.
const MAX_GAP_S: f64 = 0.5;

impl WheelAngles {
    /// The angles by counters that wrap at 2^16, by rising stamp; `ticks_per_turn` of a wheel. A reading that is not newer than the
    /// last is skipped.
    #[must_use]
    pub fn new(ticks: &[WheelTicks], ticks_per_turn: f64) -> Self {
        let mut readings: Vec<Reading> = Vec::with_capacity(ticks.len());
        let mut counters = None;
        let angle = |later: u16, earlier: u16| {
            f64::from(later.wrapping_sub(earlier).cast_signed()) * std::f64::consts::TAU / ticks_per_turn
        };
        for now in ticks {
            let stamp = now.stamp;
            match (readings.last().copied(), counters) {
                (Some(last), _) if stamp <= last.stamp => continue,
                (Some(last), Some((left, right))) => readings.push(Reading {
                    stamp,
                    left: last.left + angle(now.left, left),
                    right: last.right + angle(now.right, right),
                    gaps: last.gaps + usize::from(stamp - last.stamp > MAX_GAP_S),
                }),
                _ => readings.push(Reading { stamp, left: 0.0, right: 0.0, gaps: 0 }),
            }
            counters = Some((now.left, now.right));
        }
        Self { readings }
    }

    /// Number of readings.
    #[must_use]
    pub fn len(&self) -> usize {
        self.readings.len()
    }

    /// Whether no reading was added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.readings.is_empty()
    }

    /// Turns of the wheels between two stamps; `None` if a stamp is not covered or a gap is in between.
    pub(super) fn turn(&self, from: Stamp, to: Stamp) -> Option<WheelTurn> {
        let (start, end) = (self.at(from)?, self.at(to)?);
        let turn = WheelTurn { left: end.left - start.left, right: end.right - start.right };
        (start.gaps == end.gaps).then_some(turn)
    }

    fn at(&self, stamp: Stamp) -> Option<Reading> {
        let after = self.readings.partition_point(|reading| reading.stamp < stamp);
        let next = *self.readings.get(after)?;
        if next.stamp == stamp {
            return Some(next);
        }
        let last = self.readings.get(after.checked_sub(1)?)?;
        let fraction = (stamp - last.stamp) / (next.stamp - last.stamp);
        let between = |a: f64, b: f64| a + (b - a) * fraction;
        let (left, right) = (between(last.left, next.left), between(last.right, next.right));
        (last.gaps == next.gaps).then_some(Reading { stamp, left, right, gaps: next.gaps })
    }
}
