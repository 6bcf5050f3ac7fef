//! YAML files as a tree of values, with uniform errors and the line of each key.

use crate::IoError;
use crate::excerpt::excerpt;
use crate::files::is_decimal_comma;
use serde::Deserialize;
use serde_saphyr::{Error, NonFiniteFloatPolicy, Options};
use std::collections::BTreeMap;
use std::path::Path;
use trundle_core::Invalid;

/// A value of a YAML file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub(crate) enum YamlValue {
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<YamlValue>),
    Map(BTreeMap<String, YamlValue>),
    Null(()),
}

/// A YAML file: the first of its documents.
pub(crate) struct YamlDocument<'a> {
    path: &'a Path,
    text: &'a str,
    root: BTreeMap<String, YamlValue>,
}

impl<'a> YamlDocument<'a> {
    /// The document of a file's text. OpenCV's header `%YAML:1.0` and its matrix tags are passed over.
    pub(crate) fn parse(path: &'a Path, text: &'a str) -> Result<Self, IoError> {
        refuse_repeated_key(path, text)?;
        let plain = first_document(text);
        let root = serde_saphyr::from_str_with_options(&plain, options())
            .map_err(|error| syntax_error(path, text, &error))?;
        Ok(Self { path, text, root })
    }

    /// The value of a key, which may lead into a table: `Camera.fx` is the key itself or `fx` in the table `Camera`.
    pub(crate) fn get(&self, key: &str) -> Option<&YamlValue> {
        let value = match (self.root.get(key), key.split_once('.')) {
            (Some(value), _) => Some(value),
            (None, Some((table, inner))) => match self.root.get(table) {
                Some(YamlValue::Map(map)) => map.get(inner),
                _ => None,
            },
            (None, None) => None,
        };
        value.filter(|value| **value != YamlValue::Null(()))
    }

    /// The first existing key, else the first one.
    pub(crate) fn first_of<'k>(&self, keys: &[&'k str]) -> &'k str {
        keys.iter().find(|key| self.get(key).is_some()).unwrap_or(&keys[0])
    }

    /// The value of a required key.
    pub(crate) fn require(&self, key: &str, expected: &str) -> Result<&YamlValue, IoError> {
        self.get(key)
            .ok_or_else(|| IoError::malformed(self.path, format!("{key} is missing, expected {expected}")))
    }

    /// The number of a required key.
    pub(crate) fn number(&self, key: &str, expected: &str) -> Result<f64, IoError> {
        self.as_number(key, self.require(key, expected)?, expected)
    }

    /// The number of a key, or a default for a missing key.
    pub(crate) fn number_or(&self, key: &str, default: f64, expected: &str) -> Result<f64, IoError> {
        self.get(key).map_or(Ok(default), |value| self.as_number(key, value, expected))
    }

    /// The numbers of a required list.
    pub(crate) fn numbers(&self, key: &str, expected: &str) -> Result<Vec<f64>, IoError> {
        match self.require(key, expected)? {
            YamlValue::List(list) => list.iter().map(|value| self.as_number(key, value, expected)).collect(),
            other => Err(self.wrong(key, other, expected)),
        }
    }

    /// The text of a required key.
    pub(crate) fn text(&self, key: &str, expected: &str) -> Result<&str, IoError> {
        match self.require(key, expected)? {
            YamlValue::Text(text) => Ok(text),
            other => Err(self.wrong(key, other, expected)),
        }
    }

    /// The error of a value that is not accepted, with the line of its key.
    pub(crate) fn wrong(&self, key: &str, value: &YamlValue, expected: &str) -> IoError {
        self.invalid(Invalid::new(key, words(value), "", expected))
    }

    /// The error with the line of its field's first key.
    pub(crate) fn invalid(&self, invalid: Invalid) -> IoError {
        let key = invalid.field.split(' ').next().unwrap_or_default();
        match self.line_of(key) {
            Some(line) => IoError::line(self.path, line, invalid.to_string()),
            None => IoError::field(self.path)(invalid),
        }
    }

    fn as_number(&self, key: &str, value: &YamlValue, expected: &str) -> Result<f64, IoError> {
        match value {
            YamlValue::Number(number) => Ok(*number),
            YamlValue::Text(text) if is_decimal_comma(text) => {
                let expected = format!("a decimal point: {} ({expected})", text.replace(',', "."));
                Err(self.wrong(key, value, &expected))
            }
            other => Err(self.wrong(key, other, expected)),
        }
    }

    /// The line of a key, from 1.
    fn line_of(&self, key: &str) -> Option<usize> {
        let inner = key.split_once('.').map_or(key, |(_, inner)| inner);
        let find = |key: &str| self.text.lines().position(|line| key_of(line.trim_start()) == Some(key));
        find(key).or_else(|| find(inner)).map(|line| line + 1)
    }
}

/// A value in a message.
fn words(value: &YamlValue) -> String {
    match value {
        YamlValue::Bool(value) => value.to_string(),
        YamlValue::Number(value) => value.to_string(),
        YamlValue::Text(text) => format!("'{}'", excerpt(text)),
        YamlValue::List(list) => format!("a list of {}", list.len()),
        YamlValue::Map(_) => "a table".to_owned(),
        YamlValue::Null(()) => "empty".to_owned(),
    }
}

/// The key of a line `key: value`.
fn key_of(line: &str) -> Option<&str> {
    let (key, rest) = line.split_once(':')?;
    let is_key = rest.is_empty() || rest.starts_with(char::is_whitespace);
    is_key.then(|| key.trim_end().trim_matches(['"', '\'']))
}

fn refuse_repeated_key(path: &Path, text: &str) -> Result<(), IoError> {
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    for (i, line) in text.lines().enumerate() {
        if line == "---" && !seen.is_empty() {
            break;
        }
        let is_top = line.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '"' || c == '\'');
        let Some(key) = key_of(line).filter(|_| is_top) else { continue };
        if let Some(first) = seen.insert(key, i + 1) {
            let problem =
                format!("{} is there a second time, the first in line {first}; expected once", excerpt(key));
            return Err(IoError::line(path, i + 1, problem));
        }
    }
    Ok(())
}

/// The first document without OpenCV's header and tags, line for line.
fn first_document(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut is_begun = false;
    for line in text.lines() {
        let is_mark = line.trim_end() == "---" || line.trim_end() == "...";
        if is_mark && is_begun {
            break;
        }
        let is_passed_over = is_mark || line.starts_with("%YAML");
        is_begun |= !is_passed_over && !line.trim().is_empty() && !line.starts_with('#');
        if !is_passed_over {
            plain.push_str(&line.replace("!!opencv-matrix", ""));
        }
        plain.push('\n');
    }
    plain
}

/// Options of the parser: a number that is not finite is read as its text, which makes the error name its key.
fn options() -> Options {
    serde_saphyr::options! { non_finite_float_policy: NonFiniteFloatPolicy::AsString }
}

/// The parser's error in our words, with the line of the file.
fn syntax_error(path: &Path, text: &str, error: &Error) -> IoError {
    let error = error.without_snippet();
    let line = error.location().and_then(|at| usize::try_from(at.line()).ok()).filter(|line| *line > 0);
    let Some(line) = line else {
        return IoError::malformed(path, "no valid YAML, expected lines of `key: value`");
    };
    // The parser may name the line before a tab.
    let lines = text.lines().enumerate().skip(line - 1).filter(|(_, content)| !content.trim().is_empty());
    if let Some((i, _)) = lines.take(2).find(|(_, content)| is_indented_by_tab(content)) {
        return IoError::line(path, i + 1, "the line is indented by a tab, expected spaces");
    }
    let content = text.lines().nth(line - 1).unwrap_or_default();
    let problem = match error {
        Error::DuplicateMappingKey { key: Some(key), .. } => {
            format!("{} is there a second time in its table; expected once", excerpt(key))
        }
        Error::UnknownAnchor { .. } => {
            format!(
                "'{}' refers to an anchor that is not defined before, expected `&NAME`",
                excerpt(content.trim())
            )
        }
        _ => format!("'{}' is not valid YAML, expected `key: value`", excerpt(content.trim())),
    };
    IoError::line(path, line, problem)
}

fn is_indented_by_tab(line: &str) -> bool {
    line.chars().take_while(|c| c.is_whitespace()).any(|c| c == '\t')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with<T>(text: &str, read: impl Fn(&YamlDocument<'_>) -> Result<T, IoError>) -> Result<T, String> {
        let path = Path::new("a.yaml");
        YamlDocument::parse(path, text)
            .and_then(|document| read(&document))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn keys_lead_into_tables_and_opencv_headers_are_passed_over() {
        let text = "%YAML:1.0\n---\nCamera.fx: 500\nLeft:\n  fy: 1.5\nK: !!opencv-matrix\n  data: [1, 2.5]\n---\nfx: 3\n";
        assert_eq!(with(text, |d| d.number("Camera.fx", "px")), Ok(500.0));
        assert_eq!(with(text, |d| d.number("Left.fy", "px")), Ok(1.5));
        assert_eq!(with(text, |d| d.numbers("K.data", "two")), Ok(vec![1.0, 2.5]));
        assert_eq!(with(text, |d| Ok(d.get("fx").is_none())), Ok(true), "of the second document");
    }

    #[test]
    fn errors_are_in_our_words_with_their_line() {
        let size = |text: &str| with(text, |d| d.number("size", "a number (m)")).unwrap_err();
        assert_eq!(
            size("a: 1\nsize: 0,05\n"),
            "a.yaml, line 2: size is '0,05', expected a decimal point: 0.05 (a number (m))"
        );
        assert_eq!(size("a: 1\n"), "a.yaml: size is missing, expected a number (m)");
        assert_eq!(size("size: [1]\n"), "a.yaml, line 1: size is a list of 1, expected a number (m)");
        assert_eq!(size("size:\n"), "a.yaml: size is missing, expected a number (m)");
        assert_eq!(
            size("size: 1\na: 2\nsize: 3\n"),
            "a.yaml, line 3: size is there a second time, the first in line 1; expected once"
        );
        assert_eq!(size("size: [.nan, 1]\n"), "a.yaml, line 1: size is a list of 2, expected a number (m)");
        assert_eq!(size("size: .inf\n"), "a.yaml, line 1: size is '.inf', expected a number (m)");
        assert_eq!(
            size("%YAML:1.0\na:\n  b: 1\n  b: 2\n"),
            "a.yaml, line 4: b is there a second time in its table; expected once"
        );
        assert_eq!(
            size("a: *b\n"),
            "a.yaml, line 1: 'a: *b' refers to an anchor that is not defined before, expected `&NAME`"
        );
        assert_eq!(size("a:\n\tb: 1\n"), "a.yaml, line 2: the line is indented by a tab, expected spaces");
        for text in
            ["a:\n  b: 1\n\tc: 2\n", "a: 1\n# note\n\tb: 2\n", "a:\n  - 1\n\t- 2\n", "a: 1\n\n\tsize: 2\n"]
        {
            assert_eq!(
                size(text),
                "a.yaml, line 3: the line is indented by a tab, expected spaces",
                "{text}"
            );
        }
        assert_eq!(with("a: &x [1, 2]\nb: *x\n", |d| d.numbers("b", "two")), Ok(vec![1.0, 2.0]));
        let list = |text: &str| with(text, |d| d.numbers("size", "two numbers (m)")).unwrap_err();
        assert_eq!(list("size: [1, -.inf]\n"), "a.yaml, line 1: size is '-.inf', expected two numbers (m)");
        for text in ["{", "a: [1\n", "- a\n"] {
            let problem = size(text);
            assert!(problem.contains("not valid YAML"), "{problem}");
        }
    }
}
