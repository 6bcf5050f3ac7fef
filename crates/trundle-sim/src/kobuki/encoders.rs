//! The wheel encoders.

use trundle_core::DifferentialDrive;

/// Counters of the wheels' turning, wrapping at 2^16 as the Kobuki's.
#[derive(Debug)]
pub(super) struct Encoders {
    drive: DifferentialDrive,
    start: (u16, u16),
    /// Distance of each wheel since the start, m, of wheels of nominal radius.
    distance: (f64, f64),
}

impl Encoders {
    /// Counters with the value `start`.
    pub(super) fn new(drive: DifferentialDrive, start: (u16, u16)) -> Self {
        Self { drive, start, distance: (0.0, 0.0) }
    }

    /// Adds a motion of the wheels, m, as of wheels of nominal radius.
    pub(super) fn roll(&mut self, left: f64, right: f64) {
        self.distance = (self.distance.0 + left, self.distance.1 + right);
    }

    /// Adds ticks to the counters without a motion: a fault.
    pub(super) fn jump(&mut self, left: i32, right: i32) {
        let jumped = |start: u16, ticks: i32| start.wrapping_add(ticks as u16);
        self.start = (jumped(self.start.0, left), jumped(self.start.1, right));
    }

    /// The counters: whole ticks, without the fraction.
    pub(super) fn read(&self) -> (u16, u16) {
        let count = |start: u16, distance: f64| {
            let ticks = (distance / self.drive.metres_per_tick()).floor() as i64;
            start.wrapping_add(ticks as u16)
        };
        (count(self.start.0, self.distance.0), count(self.start.1, self.distance.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_2578_ticks_and_counters_wrap_both_ways() {
        let mut encoders = Encoders::new(DifferentialDrive::KOBUKI, (65_000, 100));
        let turn = std::f64::consts::TAU * 0.035;
        encoders.roll(turn, -turn);
        assert_eq!(encoders.read(), (65_000u16.wrapping_add(2578), 100u16.wrapping_sub(2579)));
        encoders.roll(-turn, turn);
        assert_eq!(encoders.read(), (65_000, 100));
        encoders.jump(1000, -101);
        assert_eq!(encoders.read(), (464, 65_535));
    }
}
