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
        Self { field: field.into(), value: value.to_string(), unit, expected: expected.into() }
    }
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
    fn the_sentence_names_field_value_and_unit() {
        let error = require_positive("resolution", -0.05, "m").unwrap_err();
        assert_eq!(error.to_string(), "resolution is -0.05 m, expected a finite number above 0");
        assert!(require_in("fov", f64::NAN, "rad", 0.0, 3.0).is_err());
    }
}
