//! The verdict and the key numbers of a report.

use crate::html::escape;

/// Result, in one sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// The aim was reached.
    Ok(String),
    /// The aim was missed.
    Failed(String),
    /// A run without an aim: the main fact.
    Note(String),
}

impl Verdict {
    pub(super) fn to_html(&self) -> String {
        let (class, word, sign, sentence) = match self {
            Self::Ok(sentence) => ("ok", "Passed", "M7 12.5l3.5 3.5L17.5 8.5", sentence),
            Self::Failed(sentence) => ("failed", "Failed", "M8 8l8 8M16 8l-8 8", sentence),
            Self::Note(sentence) => ("note", "Result", "M12 11v6M12 7v.1", sentence),
        };
        format!(
            "<div class=\"verdict {class}\" role=\"status\"><svg class=\"sign\" viewBox=\"0 0 24 24\" aria-hidden=\"true\">\
             <circle cx=\"12\" cy=\"12\" r=\"11\" fill=\"currentColor\"/>\
             <path d=\"{sign}\" fill=\"none\" style=\"stroke:var(--page)\" stroke-width=\"2.6\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\"/></svg><b>{word}</b><p>{}</p></div>",
            escape(sentence),
        )
    }
}

/// A key number: label, value, unit, and a remark such as its limit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Card {
    label: String,
    value: String,
    unit: String,
    remark: String,
    good: Option<bool>,
}

impl Card {
    /// A number with its name.
    pub fn new(label: &str, value: &str) -> Self {
        let (unit, remark) = (String::new(), String::new());
        Self { label: label.to_owned(), value: value.to_owned(), unit, remark, good: None }
    }

    /// The unit of the value.
    pub fn unit(self, unit: &str) -> Self {
        Self { unit: unit.to_owned(), ..self }
    }

    /// A short remark at the bottom, such as the limit of the number.
    pub fn remark(self, remark: &str) -> Self {
        Self { remark: remark.to_owned(), ..self }
    }

    /// Whether the number passes its limit.
    pub fn good(self, good: bool) -> Self {
        Self { good: Some(good), ..self }
    }

    pub(super) fn to_html(&self) -> String {
        let (class, sign) = match self.good {
            Some(true) => (" good", "\u{2713} "),
            Some(false) => (" bad", "\u{2717} "),
            None => ("", ""),
        };
        let [label, value, unit, remark] =
            [&self.label, &self.value, &self.unit, &self.remark].map(|t| escape(t));
        let remark = match sign.len() + remark.len() {
            0 => remark,
            _ => format!("<div class=\"remark\">{sign}{remark}</div>"),
        };
        format!(
            "<div class=\"card{class}\"><div class=\"label\">{label}</div>\
             <div class=\"value\">{value} <small>{unit}</small></div>{remark}</div>"
        )
    }
}
