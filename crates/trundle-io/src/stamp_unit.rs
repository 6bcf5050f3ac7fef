//! Units of the stamps of a text file, recognised by their magnitude.

use crate::excerpt::excerpt;
use crate::stamp_text::parse_scaled_stamp;
use std::fmt;
use trundle_core::{Invalid, Stamp};

/// Smallest number that is read as milliseconds. As seconds it would be the year 5138. Source: ours.
const MIN_MILLISECONDS: f64 = 1e11;
/// Smallest number that is read as microseconds. As milliseconds it would be the year 5138. Source: ours.
const MIN_MICROSECONDS: f64 = 1e14;
/// Smallest number that is read as nanoseconds. As microseconds it would be the year 5138. Source: ours.
const MIN_NANOSECONDS: f64 = 1e17;
/// Smallest median step between whole-numbered stamps at which their unit is milliseconds, not seconds \[s\]. Images and poses 5 s apart are not a
/// sequence. Source: ours.
const MIN_STEP_MILLISECONDS: f64 = 5.0;
/// Smallest median step between whole-numbered stamps at which their unit is microseconds, not milliseconds \[ms\]. Source: ours.
const MIN_STEP_MICROSECONDS: f64 = 1e3;
/// Smallest median step between whole-numbered stamps at which their unit is nanoseconds, not microseconds \[us\]. Source: ours.
const MIN_STEP_NANOSECONDS: f64 = 1e6;

/// The unit of a file's stamps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StampUnit {
    Seconds,
    Milliseconds,
    Microseconds,
    Nanoseconds,
}

impl StampUnit {
    /// The unit of a file's stamps, by the largest stamp, or for whole numbers by their usual step.
    pub(crate) fn of(texts: &[&str]) -> Self {
        let stamps: Vec<f64> = texts.iter().filter_map(|text| text.parse().ok()).collect();
        let largest = stamps.iter().fold(0.0_f64, |largest, stamp| largest.max(stamp.abs()));
        match largest {
            MIN_NANOSECONDS.. => Self::Nanoseconds,
            MIN_MICROSECONDS.. => Self::Microseconds,
            MIN_MILLISECONDS.. => Self::Milliseconds,
            _ if texts.iter().all(|text| is_whole(text)) => by_step(&stamps),
            _ => Self::Seconds,
        }
    }

    /// The stamp of a text in this unit.
    pub(crate) fn parse(self, text: &str) -> Result<Stamp, Invalid> {
        parse_scaled_stamp(text, self.decimals())
    }

    /// The warning for stamps in another unit than seconds.
    pub(crate) fn warning(self, first: &str) -> Option<String> {
        let problem = || format!("timestamps as {} are taken as {self}, expected seconds", excerpt(first));
        (self != Self::Seconds).then(problem)
    }

    fn decimals(self) -> i64 {
        match self {
            Self::Seconds => 0,
            Self::Milliseconds => 3,
            Self::Microseconds => 6,
            Self::Nanoseconds => 9,
        }
    }
}

impl fmt::Display for StampUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Seconds => "seconds",
            Self::Milliseconds => "milliseconds",
            Self::Microseconds => "microseconds",
            Self::Nanoseconds => "nanoseconds",
        })
    }
}

/// Whether a stamp has digits only; one before the start of the clock has a sign.
fn is_whole(text: &str) -> bool {
    text.strip_prefix('-').unwrap_or(text).bytes().all(|byte| byte.is_ascii_digit())
}

/// The unit of whole-numbered stamps by their median step: sensors do not pause for seconds between readings.
fn by_step(stamps: &[f64]) -> StampUnit {
    let mut steps: Vec<f64> =
        stamps.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    match steps.get(steps.len() / 2) {
        Some(step) if *step >= MIN_STEP_NANOSECONDS => StampUnit::Nanoseconds,
        Some(step) if *step > MIN_STEP_MICROSECONDS => StampUnit::Microseconds,
        Some(step) if *step >= MIN_STEP_MILLISECONDS => StampUnit::Milliseconds,
        _ => StampUnit::Seconds,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_of_one_moment_are_one_stamp_in_any_unit() {
        let moment = Stamp::from_nanos(1_700_000_000_125_000_000);
        for (text, unit) in [
            ("1700000000.125", StampUnit::Seconds),
            ("1700000000125", StampUnit::Milliseconds),
            ("1700000000125000", StampUnit::Microseconds),
            ("1700000000125000000", StampUnit::Nanoseconds),
            ("1.700000000125e18", StampUnit::Nanoseconds),
        ] {
            assert_eq!(StampUnit::of(&["0", text]), unit, "{text}");
            assert_eq!(unit.parse(text).unwrap(), moment, "{text}");
            assert_eq!(unit.warning(text).is_none(), unit == StampUnit::Seconds);
        }
    }

    #[test]
    fn whole_numbers_from_zero_are_judged_by_their_step() {
        assert_eq!(StampUnit::of(&["0", "33333333", "66666666"]), StampUnit::Nanoseconds);
        assert_eq!(StampUnit::of(&["0", "20000", "40000"]), StampUnit::Microseconds);
        assert_eq!(StampUnit::of(&["0", "33", "67"]), StampUnit::Milliseconds);
        assert_eq!(StampUnit::of(&["0", "1000", "2000"]), StampUnit::Milliseconds);
        assert_eq!(StampUnit::of(&["0", "5", "10"]), StampUnit::Milliseconds);
        assert_eq!(StampUnit::of(&["0", "1", "2"]), StampUnit::Seconds);
        assert_eq!(StampUnit::of(&["0", "4", "8"]), StampUnit::Seconds);
        assert_eq!(StampUnit::of(&["-50", "0", "50"]), StampUnit::Milliseconds);
        assert_eq!(StampUnit::of(&["0.0", "33.0"]), StampUnit::Seconds);
        assert_eq!(StampUnit::of(&["0.0", "20000.0"]), StampUnit::Seconds);
        assert_eq!(StampUnit::of(&["x"]), StampUnit::Seconds);
        assert_eq!(StampUnit::of(&[]), StampUnit::Seconds);
    }
}
