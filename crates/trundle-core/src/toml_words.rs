//! The problems of TOML files in plain words instead of the parser's and serde's Rust types.

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// Characters of a line that a message repeats. Source: ours.
const MAX_EXCERPT_CHARS: usize = 40;

/// Reads a list of exactly `N` numbers; refuses another length. The TOML reader itself ignores further numbers of a longer list.
///
/// # Errors
/// When the list has another length.
pub fn number_list<'de, D: Deserializer<'de>, const N: usize>(from: D) -> Result<Option<[f64; N]>, D::Error> {
    let Some(list) = Option::<Vec<f64>>::deserialize(from)? else { return Ok(None) };
    let length = list.len();
    let exact = <[f64; N]>::try_from(list).ok();
    let expected = format!("an array of length {N}");
    exact.map(Some).ok_or_else(|| D::Error::invalid_length(length, &expected.as_str()))
}

/// The problem of a TOML file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TomlProblem {
    /// The line, from 1.
    pub line: usize,
    /// The problem, and the accepted content.
    pub message: String,
}

/// Phrases of the parser for syntax errors, and the same in plain words.
const FORM_FAULTS: [(&str, &str); 13] = [
    ("key with no value", "there is no value, expected KEY = VALUE"),
    ("missing value", "there is no value, expected KEY = VALUE"),
    ("cannot recurse further", "lists or tables are nested too deeply, expected 3 levels at most"),
    ("string values must be quoted", VALUE_WANTED),
    ("invalid value", VALUE_WANTED),
    (
        "unexpected key or value",
        "there is more after the value, expected one KEY = VALUE a line, decimals with a point",
    ),
    ("unclosed table", "the table's name is not closed, expected [NAME]"),
    ("unclosed array", "the list is not closed, expected [VALUE, VALUE]"),
    ("unclosed inline table", "the table is not closed, expected { KEY = VALUE }"),
    ("missing comma", "a comma is missing between two values"),
    ("basic string", "the text is not closed or holds a character that no text may, expected \"TEXT\""),
    ("literal string", "the text is not closed or holds a character that no text may, expected 'TEXT'"),
    ("duplicate key", "this key or table stands twice, expected it once"),
];

/// Kinds of a value.
const VALUE_WANTED: &str =
    "this is not a value, expected a number, true or false, a text in quotes, or a list in brackets";

/// Names of kinds by serde, and in plain words.
const KINDS: [(&str, &str); 15] = [
    ("f64", "a number"),
    ("f32", "a number"),
    ("usize", "a whole number, 0 or more"),
    ("u64", "a whole number, 0 or more"),
    ("u32", "a whole number from 0 to 4294967295"),
    ("u16", "a whole number from 0 to 65535"),
    ("u8", "a whole number from 0 to 255"),
    ("i64", "a whole number"),
    ("a boolean", "true or false"),
    ("a string", "a text in quotes"),
    ("string or table", "a text in quotes"),
    ("a sequence", "a list in brackets"),
    ("a map", "a table"),
    ("map", "a table"),
    ("sequence", "a list"),
];

/// The problem found in `text` at the byte `at` by a TOML parser, or by serde after it.
#[must_use]
pub fn toml_problem(text: &str, at: Option<usize>, message: &str) -> TomlProblem {
    let before = at.and_then(|at| text.get(..at)).unwrap_or_default();
    let line = 1 + before.matches('\n').count();
    let content = text.lines().nth(line - 1).unwrap_or_default().trim();
    TomlProblem { line, message: in_plain_words(content, message) }
}

/// The message for a line with this content.
fn in_plain_words(content: &str, message: &str) -> String {
    let key = content.split_once('=').map_or("", |(key, _)| key.trim());
    let subject = if key.is_empty() { "the value".to_owned() } else { excerpt(key) };
    of_value(&subject, message)
        .or_else(|| of_key(message))
        .or_else(|| of_form(content, message))
        .unwrap_or_else(|| {
            let message = message.replace('\n', ", ");
            if key.is_empty() { message } else { format!("{subject}: {message}") }
        })
}

/// Messages of serde about a value of another kind.
fn of_value(subject: &str, message: &str) -> Option<String> {
    if let Some(rest) =
        message.strip_prefix("invalid type: ").or_else(|| message.strip_prefix("invalid value: "))
    {
        let (found, wanted) = rest.rsplit_once(", expected ")?;
        return Some(format!("{subject} is {}, expected {}", found_value(found), wanted_kind(wanted)));
    }
    if let Some(rest) = message.strip_prefix("invalid length ") {
        let (found, wanted) = rest.split_once(", expected ")?;
        return Some(format!("{subject} has {found} values, expected {}", wanted_kind(wanted)));
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        return Some(format!("{subject} is {}", rest.replace('`', "")));
    }
    let wanted = message.strip_prefix("wanted ")?;
    Some(format!("{subject} is of another kind, expected {}", wanted_kind(wanted)))
}

/// Messages of serde about keys.
fn of_key(message: &str) -> Option<String> {
    if let Some(rest) = message.strip_prefix("unknown field ") {
        return Some(format!("unknown key {}", rest.replace('`', "")));
    }
    let name = message.strip_prefix("missing field ").map(|name| name.replace('`', ""));
    name.map(|name| format!("the key {name} is missing"))
}

/// Messages of the parser about the syntax of a line.
fn of_form(content: &str, message: &str) -> Option<String> {
    let (_, words) = FORM_FAULTS.iter().find(|(mark, _)| message.contains(mark))?;
    Some(format!("'{}': {words}", excerpt(content)))
}

/// A value in serde's description: its kind, then the value in quotes.
fn found_value(found: &str) -> String {
    let mut quoted = found.split('`');
    if let (Some(_), Some(value)) = (quoted.next(), quoted.next()) {
        return value.to_owned();
    }
    found.strip_prefix("string ").map_or_else(|| kind(found), excerpt)
}

fn wanted_kind(wanted: &str) -> String {
    if wanted.starts_with("struct ") {
        return "a table".to_owned();
    }
    match wanted.strip_prefix("an array of length ").or_else(|| wanted.strip_prefix("a tuple of size ")) {
        Some(length) => format!("a list of {length} values"),
        None => kind(wanted),
    }
}

fn kind(name: &str) -> String {
    KINDS.iter().find(|(serde, _)| *serde == name).map_or(name, |(_, words)| words).replace('`', "")
}

fn excerpt(text: &str) -> String {
    if text.chars().count() <= MAX_EXCERPT_CHARS {
        return text.to_owned();
    }
    text.chars().take(MAX_EXCERPT_CHARS).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str, at: usize, message: &str) -> String {
        let problem = toml_problem(text, Some(at), message);
        format!("line {}: {}", problem.line, problem.message)
    }

    #[test]
    fn values_of_another_kind_are_named_by_key_value_and_kind() {
        let text = "[a]\nspeed = 3\n";
        let at = 12;
        for (message, expected) in [
            ("invalid type: string \"abc\", expected f64", "speed is \"abc\", expected a number"),
            (
                "invalid value: integer `-1`, expected usize",
                "speed is -1, expected a whole number, 0 or more",
            ),
            (
                "invalid type: floating point `2.5`, expected u8",
                "speed is 2.5, expected a whole number from 0 to 255",
            ),
            ("invalid type: map, expected a sequence", "speed is a table, expected a list in brackets"),
            ("invalid type: integer `3`, expected struct Drive", "speed is 3, expected a table"),
            (
                "invalid length 1, expected an array of length 2",
                "speed has 1 values, expected a list of 2 values",
            ),
            ("unknown variant `x`, expected `a` or `b`", "speed is x, expected a or b"),
        ] {
            assert_eq!(words(text, at, message), format!("line 2: {expected}"));
        }
    }

    #[test]
    fn keys_and_faults_of_form_are_in_plain_words() {
        let missing = toml_problem("", None, "missing field `height`");
        assert_eq!((missing.line, missing.message.as_str()), (1, "the key height is missing"));
        let unknown = words("x = 1\n", 0, "unknown field `x`, expected one of `a`, `b`");
        assert_eq!(unknown, "line 1: unknown key x, expected one of a, b");
        let bare = words("x\n", 0, "key with no value, expected `=`");
        assert_eq!(bare, "line 1: 'x': there is no value, expected KEY = VALUE");
        let deep = words("a = [[[\n", 5, "cannot recurse further; max recursion depth met");
        assert!(deep.contains("too deep"), "{deep}");
        assert_eq!(words("a = 1", 4, "3 corners, expected more"), "line 1: a: 3 corners, expected more");
    }

    #[test]
    fn places_outside_the_text_do_no_harm() {
        assert_eq!(toml_problem("ä", Some(1), "duplicate key").line, 1);
        assert_eq!(toml_problem("a", Some(99), "duplicate key").line, 1);
    }
}
