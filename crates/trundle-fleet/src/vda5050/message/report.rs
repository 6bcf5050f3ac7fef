//! Errors in a master's format.

use serde::Serialize;

/// An error in the state of a robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ErrorReport {
    /// Type of the error, of the standard or of trundle.
    pub error_type: String,
    /// The reference.
    pub error_references: Vec<ErrorReference>,
    /// The error in a sentence.
    pub error_description: String,
    /// The remedy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_hint: Option<String>,
    /// Whether the robot can continue.
    pub error_level: ErrorLevel,
}

/// Reference of an error: the name of a field and its value.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct ErrorReference {
    reference_key: String,
    reference_value: String,
}

/// Whether the robot can continue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ErrorLevel {
    /// The robot can continue.
    Warning,
    /// A person must help.
    Fatal,
}

impl ErrorReport {
    /// An error after which the robot can continue.
    pub fn warning(error_type: &str, description: impl Into<String>) -> Self {
        Self {
            error_type: error_type.to_owned(),
            error_references: Vec::new(),
            error_description: description.into(),
            error_hint: None,
            error_level: ErrorLevel::Warning,
        }
    }

    /// This report with a reference: key and value.
    #[must_use]
    pub fn about(mut self, key: &str, value: impl ToString) -> Self {
        let (reference_key, reference_value) = (key.to_owned(), value.to_string());
        self.error_references.push(ErrorReference { reference_key, reference_value });
        self
    }

    /// This report with a hint: the remedy.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.error_hint = Some(hint.into());
        self
    }
}
