//! The error of a refused value, and the checks that constructors share.

use thiserror::Error;

/// A value that a constructor refuses: field, value, unit and accepted values.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} is {value}{unit}, expected {expected}", unit = if unit.is_empty() { String::new() } else { format!(" {unit}") })]
pub struct Invalid {
    /// The field or argument, as the user wrote it.
    pub field: String,
    /// The refused value.
    pub value: String,
    /// Unit of the value; empty without a unit.
    pub unit: &'static str,
    /// The accepted values.
    pub expected: String,
}

impl Invalid {
    /// An error for `field`, whose `value` (in `unit`, may be empty) is not `expected`.
    pub fn new(
        field: impl Into<String>,
        value: impl ToString,
        unit: &'static str,
        expected: impl Into<String>,
    ) -> Self {
        let value = value.to_string();
        Self {
            field: field.into(),
            value: short_number(&value).unwrap_or(value),
            unit,
            expected: expected.into(),
        }
    }
}

/// Length of a number above which it is written with an exponent \[characters\]. Source: ours, a stamp in nanoseconds has 19 digits.
const MAX_NUMBER_LENGTH: usize = 24;

/// A number with an exponent, if its digits would fill a line: `1e300`.
fn short_number(text: &str) -> Option<String> {
    let is_long = text.len() > MAX_NUMBER_LENGTH && text.bytes().all(|byte| b"0123456789.-".contains(&byte));
    let number: f64 = if is_long { text.parse().ok()? } else { return None };
    Some(format!("{number:e}"))
}

/// Passes a finite number through.
///
/// # Errors
/// When `value` is NaN or infinite.
pub fn require_finite(field: &str, value: f64, unit: &'static str) -> Result<f64, Invalid> {
    if value.is_finite() { Ok(value) } else { Err(Invalid::new(field, value, unit, "a finite number")) }
}

/// Passes a finite number above zero through.
///
/// # Errors
/// When `value` is NaN, infinite, zero or negative.
pub fn require_positive(field: &str, value: f64, unit: &'static str) -> Result<f64, Invalid> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Invalid::new(field, value, unit, "a finite number above 0"))
    }
}

/// Passes a number in the closed range `low..=high` through.
///
/// # Errors
/// When `value` is NaN or outside.
pub fn require_in(field: &str, value: f64, unit: &'static str, low: f64, high: f64) -> Result<f64, Invalid> {
    if value >= low && value <= high {
        Ok(value)
    } else {
        Err(Invalid::new(field, value, unit, format!("{low} to {high}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_many_digits_is_written_with_an_exponent() {
        for (value, text) in
            [(1e300, "1e300"), (-1e-300, "-1e-300"), (1.5, "1.5"), (1.7e18, "1700000000000000000")]
        {
            let message = require_in("x", value, "m", 2.0, 3.0).unwrap_err().to_string();
            assert_eq!(message, format!("x is {text} m, expected 2 to 3"));
        }
        let words = "a".repeat(300);
        assert_eq!(Invalid::new("x", &words, "", "y").value, words);
    }

    #[test]
    fn the_sentence_names_field_value_and_unit() {
        let error = require_positive("resolution", -0.05, "m").unwrap_err();
        assert_eq!(error.to_string(), "resolution is -0.05 m, expected a finite number above 0");
        assert!(require_in("fov", f64::NAN, "rad", 0.0, 3.0).is_err());
    }
}
