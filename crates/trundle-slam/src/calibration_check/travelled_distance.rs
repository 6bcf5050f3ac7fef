use crate::calibration_check::issue::CalibrationIssue;

/// Way, by the camera or by the wheels, before they are compared, m.
const LEAST: f64 = 0.5;
/// Way by the wheels that is none, m.
const STANDING: f64 = 0.02;
/// How many times as far, or as short, is suspicious: wheels slip and floors tilt, but not by half.
const MOST: f64 = 1.5;

/// Whether the camera's way is as long as the wheels'.
#[derive(Debug, Clone, Default)]
pub(crate) struct TravelledDistance {
    seen: f64,
    said: f64,
    judged: bool,
}

impl TravelledDistance {
    /// Takes a step of so many metres as the camera saw it and as the wheels said; judges once.
    pub fn record(&mut self, seen: f64, said: f64) -> Option<CalibrationIssue> {
        self.seen += seen;
        self.said += said;
        if self.judged || self.said < STANDING || self.seen.max(self.said) < LEAST {
            return None;
        }
        self.judged = true;
        let ratio = self.seen / self.said;
        (!(1.0 / MOST..=MOST).contains(&ratio)).then_some(CalibrationIssue::TravelledDistance { ratio })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_five_times_as_long_is_noticed_once() {
        let mut check = TravelledDistance::default();
        let said: Vec<_> = (0..20).filter_map(|_| check.record(0.25, 0.05)).collect();
        assert_eq!(said.len(), 1);
        assert!(
            matches!(said[0], CalibrationIssue::TravelledDistance { ratio } if (ratio - 5.0).abs() < 1e-9)
        );
        let mut check = TravelledDistance::default();
        assert_eq!((0..20).find_map(|_| check.record(0.055, 0.05)), None);
    }
}
