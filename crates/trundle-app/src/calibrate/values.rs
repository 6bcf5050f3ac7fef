//! Calibrated values next to the values in use: the table and the robot file.

/// A calibrated value.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedValue {
    /// Name of the value; the key, if the value is a setting of the robot file.
    pub name: String,
    /// Whether the name is a key of the robot file, which `Calibration::write` sets.
    pub is_key: bool,
    /// The value.
    pub value: f64,
    /// Standard deviation; `None` for a number without an estimate.
    pub sigma: Option<f64>,
    /// Unit of both.
    pub unit: &'static str,
    /// The value in use before calibration; `None` if the robot file has none.
    pub before: Option<f64>,
    /// Decimals that are printed and written.
    pub decimals: usize,
}

/// The result of a calibration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Calibration {
    /// The values.
    pub values: Vec<CalibratedValue>,
    /// Notes for a person: quality of the fit, and values that the recording does not show.
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

    /// A number that is not a key of the robot file.
    pub(super) fn info(name: &str, (value, sigma): (f64, f64), unit: &'static str, decimals: usize) -> Self {
        let name = name.to_owned();
        Self { name, is_key: false, value, sigma: Some(sigma), unit, before: None, decimals }
    }

    /// The value as text, for the table and the robot file.
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
}
