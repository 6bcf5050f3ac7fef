//! Keys that a table of a robot file lacks.

use super::reference::{Setting, reference};
use super::value_kind::wanted;
use toml::de::{DeTable, DeValue};

/// Place of a missing field: the table's offset in the text, and the keys absent from the table.
pub(super) fn missing_keys(given: &DeTable<'_>, error: &toml::de::Error) -> Option<(usize, String)> {
    let field = error.message().strip_prefix("missing field `")?.strip_suffix('`')?;
    let lacks = |setting: &&Setting| setting.field() == field && table_of(given, setting.path).is_some();
    let first = reference().iter().find(lacks)?;
    let (at, table) = table_of(given, first.path)?;
    let siblings = reference().iter().filter(|setting| setting.table() == first.table());
    let is_missed = |setting: &&Setting| setting.field() == field || is_required(setting);
    let missing = siblings.filter(|setting| !table.contains_key(setting.field())).filter(is_missed);
    let missing: Vec<String> =
        missing.map(|setting| format!("{} ({})", setting.name(), wanted(setting))).collect();
    let table = first.table();
    Some((at, format!("[{table}] lacks {}; it goes whole or not at all", missing.join(", "))))
}

/// The table of the file without the field at `path`, with its place in the text.
fn table_of<'a, 'i>(given: &'a DeTable<'i>, path: &str) -> Option<(usize, &'a DeTable<'i>)> {
    let (head, rest) = path.split_once('.')?;
    let value = given.get(head)?;
    let DeValue::Table(table) = value.get_ref() else { return None };
    if rest.contains('.') {
        return table_of(table, rest);
    }
    (!table.contains_key(rest)).then(|| (value.span().start, table))
}

/// Whether a table without this setting cannot be read.
fn is_required(setting: &Setting) -> bool {
    !setting.doc.contains("Default")
}
