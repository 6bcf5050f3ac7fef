//! Rows of numbers with a stamp: the text tables of trajectories and odometry.

use crate::excerpt::excerpt;
use crate::files::{fields, is_decimal_comma, table_rows};
use crate::stamp_unit::StampUnit;
use crate::{IoError, Warnings};
use std::path::Path;
use trundle_core::Stamp;

/// Treatment of a row that cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BrokenRows {
    /// The file is refused.
    Refused,
    /// The row is left out with a warning.
    LeftOut,
}

/// A text table and its reading options.
#[derive(Clone, Copy)]
pub(super) struct Table<'a> {
    pub path: &'a Path,
    pub text: &'a str,
    /// Names of the numbers after the stamp.
    pub names: &'a [&'a str],
    /// Whether further columns may follow, which are ignored.
    pub is_open: bool,
    /// Unit of the stamps by the file's form; another one than this or seconds is warned of.
    pub unit: StampUnit,
    pub broken_rows: BrokenRows,
}

impl Table<'_> {
    /// The rows sorted by stamp, each made from its numbers. Stamps in another unit and rows out of order give a warning.
    pub(super) fn read<T>(
        &self,
        row: impl Fn(&[f64]) -> Result<T, String>,
        warnings: &mut Warnings,
    ) -> Result<Vec<(Stamp, T)>, IoError> {
        let lines = table_rows(self.text);
        let stamps: Vec<&str> = lines.iter().filter_map(|(_, line)| fields(line).next()).collect();
        let unit = StampUnit::of(&stamps);
        let warning = unit.warning(stamps.first().unwrap_or(&"")).filter(|_| unit != self.unit);
        if let Some(problem) = warning {
            warnings.add(&problem, &self.path.display().to_string());
        }
        let mut rows = Vec::with_capacity(lines.len());
        for (number, line) in lines {
            match self.row(unit, line).and_then(|(stamp, numbers)| Ok((stamp, row(&numbers)?))) {
                Ok(read) => rows.push(read),
                Err(problem) if self.broken_rows == BrokenRows::Refused => {
                    return Err(IoError::line(self.path, number, problem));
                }
                Err(problem) => self.warn(warnings, &format!("row left out, {problem}"), number),
            }
        }
        sort(&mut rows, self.path, warnings);
        Ok(rows)
    }

    /// The stamp and the numbers of a line.
    fn row(&self, unit: StampUnit, line: &str) -> Result<(Stamp, Vec<f64>), String> {
        if let Some(word) = decimal_comma(line) {
            return Err(format!("'{}' has a decimal comma, expected a decimal point", excerpt(word)));
        }
        let parts: Vec<&str> = fields(line).collect();
        let expected = self.names.len() + 1;
        if parts.len() < expected || (parts.len() > expected && !self.is_open) {
            return Err(format!(
                "{} fields, expected {expected}: timestamp {}",
                parts.len(),
                self.names.join(" ")
            ));
        }
        let stamp = unit.parse(parts[0]).map_err(|invalid| invalid.to_string())?;
        let named = parts[1..].iter().zip(self.names);
        let numbers = named.map(|(text, name)| number(name, text)).collect::<Result<_, _>>()?;
        Ok((stamp, numbers))
    }

    fn warn(&self, warnings: &mut Warnings, problem: &str, line: usize) {
        warnings.add(problem, &format!("{}, line {line}", self.path.display()));
    }
}

/// The first number with a comma in place of the decimal point, in a line whose numbers are separated by blanks alone.
fn decimal_comma(line: &str) -> Option<&str> {
    let mut words = line.split_whitespace();
    let are_blanks_alone = words.clone().count() > 1 && words.clone().all(|word| !word.ends_with(','));
    let is_number = |word: &&str| !word.starts_with(',') && is_decimal_comma(word);
    are_blanks_alone.then(|| words.find(is_number)).flatten()
}

/// A finite number of a name.
pub(super) fn number(name: &str, text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| format!("{name} is '{}', expected a finite number", excerpt(text)))
}

/// Sorts rows by stamp; rows of one stamp keep their order.
pub(super) fn sort<T>(rows: &mut [(Stamp, T)], path: &Path, warnings: &mut Warnings) {
    let out_of_order = rows.windows(2).filter(|pair| pair[1].0 < pair[0].0).count();
    if out_of_order > 0 {
        let rows = rows.len();
        warnings.add(
            &format!("rows with an earlier timestamp than the row before: {out_of_order} of {rows}; the rows are sorted"),
            &path.display().to_string(),
        );
    }
    rows.sort_by_key(|(stamp, _)| *stamp);
}
