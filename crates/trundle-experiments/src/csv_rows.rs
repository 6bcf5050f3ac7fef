//! Rows of comma-separated values, with file, line and column in each message.

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
    /// When it is none; names file, line and column.
    pub fn number<T: FromStr>(&self, column: usize) -> Result<T, AppError> {
        let cell = &self.cells[column];
        let wrong =
            |_| AppError::Input(format!("{}, column {}: '{cell}' is not a number", self.place, column + 1));
        cell.parse().map_err(wrong)
    }
}

/// The lines after the first of a file of comma-separated values, each with `columns` or more.
///
/// # Errors
/// When it cannot be read, or a line is too short.
pub fn rows(file: &Path, columns: usize) -> Result<Vec<Row>, AppError> {
    let name = file.display();
    let refused = |error: std::io::Error| match error {
        error if error.kind() == ErrorKind::NotFound => {
            let problem = "is not there: the data set does not come with trundle, --data names its folder";
            AppError::Input(format!("{name} {problem}"))
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
