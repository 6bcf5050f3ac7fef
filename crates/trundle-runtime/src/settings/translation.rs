//! Translates keys of a robot file to names of fields; refuses unknown and doubled keys.

use super::former_names::present_key;
use super::reference::{Setting, reference};
use super::value_kind::{kind_problem, wanted};
use serde::Deserialize;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// The table with field names in place of keys; reports unknown and doubled keys to `refuse`.
pub(super) fn translate<'i>(
    table: DeTable<'i>,
    prefix: &str,
    warnings: &mut Vec<String>,
    refuse: &mut impl FnMut(usize, String),
) -> DeTable<'i> {
    let mut translated = DeTable::new();
    for (key, value) in table {
        let full = if prefix.is_empty() { key.to_string() } else { format!("{prefix}.{}", key.get_ref()) };
        let (span, value_span) = (key.span(), value.span());
        let found = find(&full);
        if let Some(problem) = found.as_ref().and_then(|found| kind_problem_of(&full, found, &value)) {
            refuse(value_span.start, problem);
            continue;
        }
        let field: Cow<'i, str> = match found {
            Some(Found::Key(setting)) => setting.field().into(),
            Some(Found::OldKey(setting)) => {
                warnings.push(format!("{full} is deprecated: write {}", setting.key));
                setting.field().into()
            }
            Some(Found::Table) => key.into_inner(),
            None => {
                refuse(span.start, unknown(&full, prefix));
                continue;
            }
        };
        let value = match value.into_inner() {
            DeValue::Table(inner) => DeValue::Table(translate(inner, &full, warnings, refuse)),
            other => other,
        };
        if translated.insert(Spanned::new(span.clone(), field), Spanned::new(value_span, value)).is_some() {
            refuse(span.start, format!("{full} is set twice, once under its old name"));
        }
    }
    translated
}

/// The problem of the kind of a value in the file.
fn kind_problem_of(key: &str, found: &Found, value: &Spanned<DeValue<'_>>) -> Option<String> {
    match found {
        Found::Key(setting) | Found::OldKey(setting) => {
            let plain = toml::Value::deserialize(ValueDeserializer::from(value.clone()));
            plain.map_or_else(
                |_| Some(format!("{key} is beyond what can be read, expected {}", wanted(setting))),
                |value| kind_problem(setting, &value),
            )
        }
        Found::Table => (!matches!(value.get_ref(), DeValue::Table(_))).then(|| {
            format!(
                "{key} is a table of settings, expected [{key}] on a line of its own, or {key}.NAME = VALUE"
            )
        }),
    }
}

/// Kind of a dotted key.
pub(super) enum Found {
    Key(&'static Setting),
    OldKey(&'static Setting),
    Table,
}

/// Kind of a dotted key of a robot file; `None` for an unknown key.
pub(super) fn find(full: &str) -> Option<Found> {
    let inside = |setting: &Setting| setting.key.strip_prefix(full).is_some_and(|rest| rest.starts_with('.'));
    let settings = reference();
    let named = |key: &str| settings.iter().find(|setting| setting.key == key);
    let of_path = |path: &str| settings.iter().find(|setting| setting.path == path);
    let former = || present_key(full).and_then(|present| named(&present).or_else(|| of_path(&present)));
    let key = named(full).map(Found::Key);
    let old = || of_path(full).or_else(former).map(Found::OldKey);
    key.or_else(old).or_else(|| settings.iter().any(inside).then_some(Found::Table))
}

/// Error text for an unknown key, with the other keys of its table.
pub(super) fn unknown(full: &str, prefix: &str) -> String {
    let mut names: Vec<&str> = reference()
        .iter()
        .filter_map(|setting| {
            let inner = if prefix.is_empty() {
                Some(setting.key)
            } else {
                setting.key.strip_prefix(prefix)?.strip_prefix('.')
            };
            inner.and_then(|inner| inner.split('.').next())
        })
        .collect();
    names.dedup();
    if names.is_empty() {
        return format!("unknown key {full}; {}", nearest(prefix));
    }
    let place = if prefix.is_empty() { "the robot file".to_owned() } else { format!("[{prefix}]") };
    format!("unknown key {full}; {place} has {}", names.join(", "))
}

/// Description of the name before the last point of an unknown key, if it is not a table.
fn nearest(prefix: &str) -> String {
    match find(prefix) {
        Some(Found::Key(setting) | Found::OldKey(setting)) => {
            format!("{} is itself a value, expected {}", setting.key, wanted(setting))
        }
        _ => unknown(prefix, prefix.rsplit_once('.').map_or("", |(table, _)| table)),
    }
}
