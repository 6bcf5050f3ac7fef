//! Whether the camera travels as far as the wheels.

use crate::calibration_check::issue::CalibrationIssue;

/// Distance by camera or wheels before the two are compared: 0.5 m. Source: ours.
const MIN_DISTANCE_M: f64 = 0.5;
/// Distance by the wheels below which nothing is compared: 0.02 m. Source: ours.
const MIN_WHEEL_DISTANCE_M: f64 = 0.02;
/// Ratio of the two distances, or its inverse, beyond which the depth scale or the wheels are wrong: 1.5. Wheels slip by less.
/// Source: ours.
const MAX_DISTANCE_RATIO: f64 = 1.5;

/// Compares the distance that the camera travels with that of the wheels.
#[derive(Debug, Clone, Default)]
pub(crate) struct TravelledDistance {
    seen: f64,
    reported: f64,
    judged: bool,
}

impl TravelledDistance {
    /// Records the length of a step by the camera and by the wheels, m; reports at most once.
    pub fn record(&mut self, seen: f64, reported: f64) -> Option<CalibrationIssue> {
        self.seen += seen;
        self.reported += reported;
        if self.judged
            || self.reported < MIN_WHEEL_DISTANCE_M
            || self.seen.max(self.reported) < MIN_DISTANCE_M
        {
            return None;
        }
        self.judged = true;
        let ratio = self.seen / self.reported;
        (!(1.0 / MAX_DISTANCE_RATIO..=MAX_DISTANCE_RATIO).contains(&ratio))
            .then_some(CalibrationIssue::TravelledDistance { ratio })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_five_times_as_long_is_reported_once() {
        let mut check = TravelledDistance::default();
        let reported: Vec<_> = (0..20).filter_map(|_| check.record(0.25, 0.05)).collect();
        assert_eq!(reported.len(), 1);
        assert!(
            matches!(reported[0], CalibrationIssue::TravelledDistance { ratio } if (ratio - 5.0).abs() < 1e-9)
        );
        let mut check = TravelledDistance::default();
        assert_eq!((0..20).find_map(|_| check.record(0.055, 0.05)), None);
    }
}
