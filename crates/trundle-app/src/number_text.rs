//! The number of an option as text, refused with option, value, unit and accepted range.

use trundle_core::{Invalid, MAX_COORDINATE_M};
use trundle_io::{MAX_CELL_M, MIN_CELL_M};

/// Largest angle of an option \[deg\]: a full turn. Source: ours.
const MAX_ANGLE_DEG: f64 = 360.0;
/// Largest time of an option \[s\], about 30 years. Source: ours.
const MAX_TIME_S: f64 = 1e9;

/// Finite numbers that an option accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberText {
    /// Unit, as `m`; empty without a unit.
    unit: &'static str,
    range: NumberRange,
}

/// Accepted finite numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberRange {
    /// All of them.
    Any,
    /// 0 or more.
    FromZero,
    /// A number above 0.
    AboveZero,
    /// A number above 0 and at most this.
    UpTo(f64),
    /// A number from the first to the second.
    Within(f64, f64),
}

impl NumberText {
    /// The side of a map's cell.
    pub const CELL_SIDE: Self = Self::new("m", NumberRange::Within(MIN_CELL_M, MAX_CELL_M));

    /// Numbers of `range` in `unit`.
    #[must_use]
    pub const fn new(unit: &'static str, range: NumberRange) -> Self {
        Self { unit, range }
    }

    /// Any finite number in `unit`.
    #[must_use]
    pub const fn any(unit: &'static str) -> Self {
        Self::new(unit, NumberRange::Any)
    }

    /// 0 or more in `unit`.
    #[must_use]
    pub const fn from_zero(unit: &'static str) -> Self {
        Self::new(unit, NumberRange::FromZero)
    }

    /// Above 0 in `unit`.
    #[must_use]
    pub const fn above_zero(unit: &'static str) -> Self {
        Self::new(unit, NumberRange::AboveZero)
    }

    /// Above 0 in `unit`, `limit` at most.
    #[must_use]
    pub const fn up_to(limit: f64, unit: &'static str) -> Self {
        Self::new(unit, NumberRange::UpTo(limit))
    }

    fn takes(self, value: f64) -> bool {
        value.is_finite()
            && match self.range {
                NumberRange::Any => true,
                NumberRange::FromZero => value >= 0.0,
                NumberRange::AboveZero => value > 0.0,
                NumberRange::UpTo(limit) => value > 0.0 && value <= limit,
                NumberRange::Within(low, high) => (low..=high).contains(&value),
            }
    }

    /// The largest amount of the unit; infinite for units without a limit.
    fn limit(self) -> f64 {
        match self.unit {
            "m" => MAX_COORDINATE_M,
            "deg" => MAX_ANGLE_DEG,
            "s" => MAX_TIME_S,
            _ => f64::INFINITY,
        }
    }

    fn wanted(self) -> String {
        let range = match self.range {
            NumberRange::Any => String::new(),
            NumberRange::FromZero => ", 0 or more".to_owned(),
            NumberRange::AboveZero => ", above 0".to_owned(),
            NumberRange::UpTo(limit) => format!(", above 0 and at most {limit}"),
            NumberRange::Within(low, high) => format!(", {low} to {high}"),
        };
        format!("a number{}{range}", self.in_unit())
    }

    /// The unit, as ` in m`.
    fn in_unit(self) -> String {
        if self.unit.is_empty() { String::new() } else { format!(" in {}", self.unit) }
    }

    /// The number of the text given to `option`.
    ///
    /// # Errors
    /// When the text is no finite number, or the number is outside the range or beyond the limit of its unit: the error names option, value, unit and accepted range.
    pub fn read(self, option: &str, text: &str) -> Result<f64, String> {
        let wanted = self.wanted();
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() && value.abs() > self.limit() => {
                let limit = self.limit();
                let wanted = match self.range {
                    NumberRange::Any => format!("{}, -{limit} to {limit}", self.wanted()),
                    _ => format!("{}, at most {limit}", self.wanted()),
                };
                Err(Invalid::new(option, value, self.unit, wanted).to_string())
            }
            Ok(value) if self.takes(value) => Ok(value),
            Ok(value) if value.is_finite() => Err(Invalid::new(option, value, self.unit, wanted).to_string()),
            _ => Err(format!("{option} is '{text}', expected {wanted}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::NumberRange::{AboveZero, Any, FromZero, UpTo, Within};
    use super::*;

    #[test]
    fn numbers_are_refused_with_option_value_unit_and_what_is_expected() {
        let refused =
            |range, unit, text: &str| NumberText::new(unit, range).read("--near", text).unwrap_err();
        assert_eq!(NumberText::new("m", FromZero).read("--near", " 0.5"), Ok(0.5));
        assert_eq!(refused(FromZero, "m", "abc"), "--near is 'abc', expected a number in m, 0 or more");
        assert_eq!(refused(FromZero, "m", "-1"), "--near is -1 m, expected a number in m, 0 or more");
        assert_eq!(refused(Any, "deg", "NaN"), "--near is 'NaN', expected a number in deg");
        assert_eq!(refused(AboveZero, "", "0"), "--near is 0, expected a number, above 0");
        let long = refused(UpTo(10.0), "s", "11");
        assert_eq!(long, "--near is 11 s, expected a number in s, above 0 and at most 10");
        let small = refused(Within(0.001, 10.0), "m", "1e-300");
        assert_eq!(small, "--near is 1e-300 m, expected a number in m, 0.001 to 10");
        assert_eq!(NumberText::new("m", Within(0.001, 10.0)).read("--near", "10"), Ok(10.0));
    }

    #[test]
    fn no_option_takes_a_length_angle_or_time_beyond_any_robot() {
        let refused = |unit, text: &str| NumberText::new(unit, Any).read("--by", text).unwrap_err();
        let turned = refused("deg", "-1e3");
        assert_eq!(turned, "--by is -1000 deg, expected a number in deg, -360 to 360");
        assert!(refused("m", "1e9").ends_with("-1000000 to 1000000"));
        assert!(refused("s", "1e300").ends_with("-1000000000 to 1000000000"));
        assert_eq!(NumberText::any("deg").read("--by", "-360"), Ok(-360.0));
    }
}
