//! Reading of whole files, and splitting of text files into lines and fields.

use crate::IoError;
use std::path::Path;

/// Mark that some editors put in front of UTF-8 text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// The whole file.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, IoError> {
    std::fs::read(path).map_err(IoError::system(path, "read"))
}

/// The whole file as text, without a byte order mark.
///
/// # Errors
/// When the file cannot be read; with the line if the line is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, IoError> {
    let mut text = String::from_utf8(read_bytes(path)?).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        IoError::line(path, line, "is not UTF-8 text, expected text saved as UTF-8")
    })?;
    if text.starts_with(BYTE_ORDER_MARK) {
        text.drain(..BYTE_ORDER_MARK.len_utf8());
    }
    Ok(text)
}

/// The lines with content and their numbers from 1, without blank lines and comments (`#`).
pub(crate) fn content_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// The fields of a line, between blanks or commas.
pub(crate) fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| c.is_whitespace() || c == ',').filter(|field| !field.is_empty())
}

/// The lines of a table with content, without a header line, and without a closing comma.
pub(crate) fn table_rows(text: &str) -> Vec<(usize, &str)> {
    let mut rows: Vec<(usize, &str)> = content_lines(text).collect();
    if rows.first().is_some_and(|(_, line)| is_header(line)) {
        rows.remove(0);
    }
    rows
}

/// Whether a line is a header of column names: words only, no file name.
fn is_header(line: &str) -> bool {
    let is_name = |field: &str| field.parse::<f64>().is_err() && !field.contains(['.', '/']);
    line.starts_with(|c: char| c.is_alphabetic() || c == '"') && fields(line).all(is_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_blank_lines_keep_the_numbers_right() {
        let lines: Vec<_> = content_lines("# a\n\n 1 2 \r\n#\n3,4").collect();
        assert_eq!(lines, [(3, "1 2"), (5, "3,4")]);
        assert_eq!(fields("3,\t4 ").collect::<Vec<_>>(), ["3", "4"]);
    }

    #[test]
    fn names_of_columns_are_not_a_row() {
        let rows = |text| table_rows(text).len();
        assert_eq!(rows("timestamp,tx [m],qw []\n1,2,3\n"), 1);
        assert_eq!(rows("timestamp filename\n1 a.png\n"), 1);
        assert_eq!([rows("one a.png\n"), rows("x 0 0\n"), rows("1 2\n"), rows("")], [1, 1, 1, 0]);
    }

    #[test]
    fn a_byte_order_mark_is_not_text() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "\u{feff}1.5 a.png\n").unwrap();
        assert_eq!(read_text(file.path()).unwrap(), "1.5 a.png\n");
    }

    #[test]
    fn binary_text_is_refused_with_its_line() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), b"fine\n\xff\xfe").unwrap();
        assert!(read_text(file.path()).unwrap_err().to_string().contains(", line 2: is not UTF-8 text"));
    }
}
