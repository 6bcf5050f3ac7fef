//! Rows of comma-separated values, with file, line and column in each message.

use crate::data_sets::DataSet;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::str::FromStr;
use trundle_app::AppError;

/// A line of a table.
pub struct Row {
    place: String,
    cells: Vec<String>,
}

impl Row {
    /// A cell's text.
    pub fn text(&self, column: usize) -> &str {
        &self.cells[column]
    }

    /// A cell's number.
    ///
    /// # Errors
    /// When the column is not a number; the error names file, line and column.
    pub fn number<T: FromStr>(&self, column: usize) -> Result<T, AppError> {
        let cell = &self.cells[column];
        let wrong =
            |_| AppError::Input(format!("{}, column {}: '{cell}' is not a number", self.place, column + 1));
        cell.parse().map_err(wrong)
    }
}

/// The lines after the first of a file of comma-separated values, each with `columns` or more. The file is part of `set`.
///
/// # Errors
/// When the file cannot be read, or a line is too short.
pub fn rows(file: &Path, columns: usize, set: &DataSet) -> Result<Vec<Row>, AppError> {
    let name = file.display();
    let refused = |error: std::io::Error| match error {
        error if error.kind() == ErrorKind::NotFound => {
            AppError::Input(format!("{name} is not there, --data names its folder: {}", set.how_to_get()))
        }
        error => AppError::Input(format!("{name}: {error}")),
    };
    let text = fs::read_to_string(file).map_err(refused)?;
    let row = |(i, line): (usize, &str)| {
        let place = format!("{name}, line {}", i + 1);
        let cells: Vec<String> = line.trim().split(',').map(str::to_owned).collect();
        if cells.len() < columns {
            let found = cells.len();
            return Err(AppError::Input(format!("{place}: {found} columns, expected {columns} or more")));
        }
        Ok(Row { place, cells })
    };
    text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty()).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data_sets::BARN;

    fn read(text: &str, columns: usize) -> Result<Vec<Row>, AppError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), text).unwrap();
        rows(file.path(), columns, &BARN)
    }

    #[test]
    fn the_first_line_and_blank_lines_are_left_out() {
        let rows = read("a,b\n1,x\n\n2,y\n", 2).unwrap();
        assert_eq!(rows.len(), 2);
        assert_eq!((rows[1].number::<f64>(0).unwrap(), rows[1].text(1)), (2.0, "y"));
    }

    #[test]
    fn an_error_names_line_and_column() {
        let rows = read("a,b\n1,x\n", 2).unwrap();
        let error = rows[0].number::<f64>(1).unwrap_err().to_string();
        assert!(error.ends_with("line 2, column 2: 'x' is not a number"), "{error}");
        let short = read("a,b\n1\n", 2).err().unwrap().to_string();
        assert!(short.ends_with("line 2: 1 columns, expected 2 or more"), "{short}");
        let gone = rows_of_missing();
        assert!(gone.starts_with("no/file.csv is not there") && gone.contains(BARN.command), "{gone}");
    }

    fn rows_of_missing() -> String {
        rows(Path::new("no/file.csv"), 1, &BARN).err().unwrap().to_string()
    }
}
