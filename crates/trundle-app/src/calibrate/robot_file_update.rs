//! Replaces keys of a robot file: other keys, comments and order do not change.

use super::values::{CalibratedValue, Calibration};
use crate::{AppError, read_text};
use std::path::Path;
use toml_edit::{DocumentMut, Item, Table, Value};
use trundle_core::{TomlProblem, toml_problem};
use trundle_io::{replace_file, require_replaceable};
use trundle_runtime::settings::RobotFile;

impl Calibration {
    /// Replaces the calibrated keys in a robot file. All other keys and comments are unchanged; a missing file is created.
    ///
    /// # Errors
    /// When the file is not a robot file, a calibrated value is outside the range of its key, or the file cannot be written. The file is
    /// unchanged then.
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

/// Checks that [`Calibration::write`] can set keys in this robot file.
///
/// # Errors
/// When the file is not a robot file, or cannot be written.
pub fn require_robot_file(file: &Path) -> Result<(), AppError> {
    if file.exists() {
        let text = read_text(file)?;
        let parsed = RobotFile::parse(&text, &[]);
        parsed.map_err(|error| AppError::Input(format!("{}: {error}", file.display())))?;
    }
    Ok(require_replaceable(file)?)
}

/// Sets keys of a robot file, or creates the file with them. The file is replaced as a whole or left unchanged.
pub(super) fn update_robot_file(file: &Path, values: &[&CalibratedValue]) -> Result<(), AppError> {
    let old = if file.exists() { read_text(file)? } else { String::new() };
    let refused =
        |problem: String| AppError::Input(format!("{}: {problem}; nothing was written", file.display()));
    let new = updated(&old, values).map_err(refused)?;
    RobotFile::parse(&new, &[]).map_err(|error| refused(error.to_string()))?;
    Ok(replace_file(file, new.as_bytes())?)
}

/// The text with the values set.
fn updated(text: &str, values: &[&CalibratedValue]) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        let at = error.span().map(|span| span.start);
        let TomlProblem { line, message } = toml_problem(text, at, error.message());
        format!("line {line}: {message}")
    })?;
    for value in values {
        set(document.as_table_mut(), &value.name, value)?;
    }
    Ok(document.to_string())
}

/// Sets the key at a dotted path; creates missing tables.
fn set(table: &mut Table, path: &str, value: &CalibratedValue) -> Result<(), String> {
    let Some((head, rest)) = path.split_once('.') else {
        set_leaf(table.entry(path).or_insert(Item::None), value);
        return Ok(());
    };
    let inner = table.entry(head).or_insert_with(|| Item::Table(Table::new()));
    match inner {
        Item::Table(inner) => set(inner, rest, value),
        Item::Value(Value::InlineTable(inline)) => {
            // An inline table remains an inline table.
            let mut inner =
                Table::from_iter(inline.iter().map(|(key, value)| (key.to_owned(), value.clone())));
            set(&mut inner, rest, value)?;
            *inline = inner.into_inline_table();
            Ok(())
        }
        _ => Err(format!("[{head}] is not a table")),
    }
}

/// Replaces a value; the comment after the value is preserved.
fn set_leaf(item: &mut Item, value: &CalibratedValue) {
    let number = if value.decimals == 0 {
        Value::from(value.value.round() as i64)
    } else {
        // The value as printed, rounded to its significant digits.
        Value::from(value.text().parse::<f64>().unwrap_or(value.value))
    };
    let decor = item.as_value().map(|old| old.decor().clone());
    *item = Item::Value(number);
    if let (Some(new), Some(decor)) = (item.as_value_mut(), decor) {
        *new.decor_mut() = decor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(name: &str, value: f64, decimals: usize) -> CalibratedValue {
        CalibratedValue::key(name, (value, 0.001), "m", 0.0, decimals)
    }

    #[test]
    fn other_keys_comments_and_order_stay() {
        let old =
            "# my robot\nfootprint_radius_m = 0.2\n\n[mount] # the mast\nz_m = 0.4 # by tape\nx_m = 0.1\n";
        let new =
            updated(old, &[&value("mount.z_m", 0.512_34, 4), &value("image_delay_s", 0.03, 4)]).unwrap();
        assert!(new.contains("z_m = 0.5123 # by tape\nx_m = 0.1\n"), "{new}");
        assert!(new.starts_with("# my robot\nfootprint_radius_m = 0.2\n"), "{new}");
        let read = RobotFile::parse(&new, &[]).unwrap().config;
        assert_eq!((read.mount.z, read.mount.x, read.image_delay), (0.5123, 0.1, 0.03));
    }

    #[test]
    fn tables_are_made_and_inline_tables_and_dotted_keys_are_kept() {
        let key = value("mount.z_m", 0.5, 4);
        for old in ["", "mount = { x_m = 0.2 }\n", "mount.x_m = 0.2\n", "[drive]\nwheelbase_m = 0.3\n"] {
            let new = updated(old, &[&key]).unwrap();
            assert_eq!(RobotFile::parse(&new, &[]).unwrap().config.mount.z, 0.5, "{old:?} -> {new}");
        }
    }

    #[test]
    fn a_file_that_is_not_a_robot_file_stays_as_it_is() {
        let scratch = tempfile::tempdir().unwrap();
        for old in ["mount = 3\n", "[mount\n", "[mount]\nheight = 0.3\n"] {
            let file = scratch.path().join("robot.toml");
            std::fs::write(&file, old).unwrap();
            let error = update_robot_file(&file, &[&value("mount.z_m", 0.5, 4)]).unwrap_err().to_string();
            assert!(error.contains("robot.toml") && error.contains("nothing was written"), "{error}");
            assert_eq!(std::fs::read_to_string(&file).unwrap(), old);
        }
        let file = scratch.path().join("new/robot.toml");
        update_robot_file(&file, &[&value("mount.z_m", 0.5, 4)]).unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "[mount]\nz_m = 0.5\n");
    }
}
