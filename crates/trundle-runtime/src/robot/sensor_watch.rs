//! Silent faults of wheels and gyro, for the log. The odometry tolerates these faults, but a person should know.

use trundle_core::Stamp;

/// Age of the newest gyro reading at which the gyro counts as missing \[s\]: 25 readings. Source: ours.
const GYRO_MISSING_S: f64 = 0.5;

/// A logged change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SensorChange {
    /// Gyro readings are missing: the heading comes from the wheels.
    GyroMissing,
    /// Gyro readings have returned.
    GyroBack,
    /// Encoders do not count on command: the motion comes from the images.
    WheelsUnresponsive,
    /// The encoders count again.
    WheelsBack,
}

impl SensorChange {
    pub(super) fn text(self) -> &'static str {
        match self {
            Self::GyroMissing => {
                "no readings of the gyro come: the heading comes from the wheels; check the base's cable and firmware"
            }
            Self::GyroBack => "readings of the gyro come again",
            Self::WheelsUnresponsive => {
                "the wheels are commanded to turn and count nothing: the motion comes from the images; check wheels and encoders"
            }
            Self::WheelsBack => "the wheels count again",
        }
    }
}

/// Detects silent faults of wheels and gyro.
#[derive(Debug, Default)]
pub(super) struct SensorWatch {
    /// The newest stamp of any event.
    newest: Stamp,
    /// Stamp of the newest gyro reading; before any, of the first wheel reading.
    gyro: Option<Stamp>,
    gyro_missing: SilentFault,
    wheels_unresponsive: SilentFault,
}

/// A fault that may come and go. The first, the second, the fourth and so on are logged, each with its end, so that a sensor with a low rate
/// does not fill the log.
#[derive(Debug, Default)]
struct SilentFault {
    is_present: bool,
    count: u32,
}

impl SilentFault {
    /// Number of the fault that begins or ends, if that is logged.
    fn change(&mut self, is_present: bool) -> Option<u32> {
        if is_present == self.is_present {
            return None;
        }
        self.is_present = is_present;
        self.count += u32::from(is_present);
        Some(self.count).filter(|count| count.is_power_of_two())
    }
}

impl SensorWatch {
    /// Records the stamp of an event.
    pub(super) fn on_event(&mut self, stamp: Stamp) {
        self.newest = self.newest.max(stamp);
    }

    /// The newest stamp of any event, so that the time of log lines never decreases.
    pub(super) fn newest(&self) -> Stamp {
        self.newest
    }

    /// Records a gyro reading.
    pub(super) fn on_gyro(&mut self, stamp: Stamp) {
        self.gyro = Some(stamp);
    }

    /// The changes at a wheel reading, each with the number of its fault.
    pub(super) fn on_wheels(
        &mut self,
        now: Stamp,
        are_unresponsive: bool,
    ) -> impl Iterator<Item = (SensorChange, u32)> + use<> {
        let is_missing = now - *self.gyro.get_or_insert(now) > GYRO_MISSING_S;
        let gyro = if is_missing { SensorChange::GyroMissing } else { SensorChange::GyroBack };
        let wheels =
            if are_unresponsive { SensorChange::WheelsUnresponsive } else { SensorChange::WheelsBack };
        let gyro = self.gyro_missing.change(is_missing).map(|count| (gyro, count));
        let wheels = self.wheels_unresponsive.change(are_unresponsive).map(|count| (wheels, count));
        gyro.into_iter().chain(wheels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_change_is_named_once() {
        let mut watch = SensorWatch::default();
        let at = |s: f64| Stamp::default().after(s);
        let mut changes = Vec::new();
        for i in 0..200 {
            let now = at(0.02 * f64::from(i));
            if !(50..150).contains(&i) {
                watch.on_gyro(now);
            }
            changes.extend(watch.on_wheels(now, (100..120).contains(&i)).map(|(change, _)| change));
        }
        assert_eq!(
            changes,
            [
                SensorChange::GyroMissing,
                SensorChange::WheelsUnresponsive,
                SensorChange::WheelsBack,
                SensorChange::GyroBack
            ]
        );
    }

    #[test]
    fn a_gyro_that_never_comes_is_missing_after_half_a_second() {
        let mut watch = SensorWatch::default();
        let changes = |watch: &mut SensorWatch, s: f64| {
            watch.on_wheels(Stamp::default().after(s), false).collect::<Vec<_>>()
        };
        assert!(changes(&mut watch, 5.0).is_empty() && changes(&mut watch, 5.4).is_empty());
        assert_eq!(changes(&mut watch, 5.6), [(SensorChange::GyroMissing, 1)]);
    }

    #[test]
    fn a_gyro_with_one_reading_a_second_does_not_fill_the_log() {
        let mut watch = SensorWatch::default();
        let mut changes = Vec::new();
        for i in 0..3000_i64 {
            let now = Stamp::from_nanos(20_000_000 * i);
            if i % 50 == 0 {
                watch.on_gyro(now);
            }
            changes.extend(watch.on_wheels(now, false));
        }
        let counts: Vec<_> = changes.iter().map(|(_, count)| *count).collect();
        assert_eq!(counts, [1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 32, 32]);
    }
}
