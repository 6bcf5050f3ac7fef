//! Calibrated values beside the values in use: the table and the robot file.

use super::robot_file_update::update_robot_file;
use crate::AppError;
use std::path::Path;

/// A calibrated value.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedValue {
    /// Name: for a key of the robot file the key.
    pub name: String,
    /// Whether the name is a key of the robot file, which [`Calibration::write`] sets.
    pub is_key: bool,
    /// The value.
    pub value: f64,
    /// Standard deviation; `None` of a number that is only copied.
    pub sigma: Option<f64>,
    /// Unit of both.
    pub unit: &'static str,
    /// The value in use before, where there is one.
    pub before: Option<f64>,
    /// Decimals that are printed and written.
    pub decimals: usize,
}

/// The result of a calibration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Calibration {
    /// The values.
    pub values: Vec<CalibratedValue>,
    /// What a person should know: quality of the fit, and values that the recording does not show.
    pub notes: Vec<String>,
}

impl CalibratedValue {
    /// A key of the robot file.
    pub(crate) fn key(
        name: &str,
        (value, sigma): (f64, f64),
        unit: &'static str,
        before: f64,
        decimals: usize,
    ) -> Self {
        Self {
            name: name.to_owned(),
            is_key: true,
            value,
            sigma: Some(sigma),
            unit,
            before: Some(before),
            decimals,
        }
    }

    /// A number that is no key of the robot file.
    pub(super) fn info(name: &str, (value, sigma): (f64, f64), unit: &'static str, decimals: usize) -> Self {
        let name = name.to_owned();
        Self { name, is_key: false, value, sigma: Some(sigma), unit, before: None, decimals }
    }

    /// The value as it is printed and written.
    pub(super) fn text(&self) -> String {
        format!("{:.*}", self.decimals, self.value)
    }

    fn row(&self) -> Vec<String> {
        let number =
            |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.*}", self.decimals));
        let unit = self.unit.to_owned();
        vec![self.name.clone(), self.text(), number(self.sigma), unit, number(self.before)]
    }
}

impl Calibration {
    /// The value of this name.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<&CalibratedValue> {
        self.values.iter().find(|value| value.name == name)
    }

    /// The table: name, value, standard deviation, unit, value in use before.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let head = ["value of", "found", "std. dev.", "unit", "in use"].map(str::to_owned).to_vec();
        std::iter::once(head).chain(self.values.iter().map(CalibratedValue::row)).collect()
    }

    /// Sets the found keys in a robot file. All other keys and comments stay; a file that does not exist is created.
    ///
    /// # Errors
    /// When the file is no robot file, a found value is outside the range of its key, or the file cannot be written; it is unchanged
    /// then.
    pub fn write(&self, file: &Path) -> Result<(), AppError> {
        let keys: Vec<&CalibratedValue> = self.values.iter().filter(|value| value.is_key).collect();
        if keys.is_empty() {
            let problem =
                format!("{}: nothing to write: the recording shows no value of a robot file", file.display());
            return Err(AppError::Input(problem));
        }
        update_robot_file(file, &keys)
    }
}
