//! Reading of whole files, and splitting of text files into lines and fields.

use crate::IoError;
use std::borrow::Cow;
use std::path::Path;

/// Mark that some editors put in front of UTF-8 text.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// The whole file.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, IoError> {
    std::fs::read(path).map_err(IoError::system(path, "read"))
}

/// The whole file as text, without a byte order mark. A CR alone, the line end of old Mac programs, becomes LF.
///
/// # Errors
/// When the file cannot be read; with the line if the line is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, IoError> {
    let mut text = String::from_utf8(read_bytes(path)?).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = with_line_ends(&String::from_utf8_lossy(before)).matches('\n').count() + 1;
        IoError::line(path, line, "is not UTF-8 text, expected text saved as UTF-8")
    })?;
    drop_mark(&mut text);
    Ok(with_line_ends(&text).into_owned())
}

/// The whole file as text, like [`read_text`]. Bytes that are not UTF-8 become U+FFFD: of a table, only their row is unreadable.
pub(crate) fn read_text_lossy(path: &Path) -> Result<String, IoError> {
    let mut text = String::from_utf8_lossy(&read_bytes(path)?).into_owned();
    drop_mark(&mut text);
    Ok(with_line_ends(&text).into_owned())
}

/// The text with LF in place of each CR that stands alone. A text without such line ends stays as it is.
pub(crate) fn with_line_ends(text: &str) -> Cow<'_, str> {
    let crs = text.bytes().filter(|byte| *byte == b'\r').count();
    if crs == text.matches("\r\n").count() {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))
}

fn drop_mark(text: &mut String) {
    if text.starts_with(BYTE_ORDER_MARK) {
        text.drain(..BYTE_ORDER_MARK.len_utf8());
    }
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

/// Whether a word is a number with a comma in place of its decimal point.
pub(crate) fn is_decimal_comma(word: &str) -> bool {
    let are_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let parts = word.trim_start_matches('-').split_once(',');
    parts.is_some_and(|(whole, part)| are_digits(whole) && are_digits(part) && !part.is_empty())
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
    fn a_cr_alone_ends_a_line_and_a_cr_before_lf_does_not_end_a_second_one() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let read = |bytes: &[u8]| {
            std::fs::write(file.path(), bytes).unwrap();
            [read_text(file.path()), read_text_lossy(file.path())].map(|text| text.map_err(|e| e.to_string()))
        };
        assert_eq!(read(b"1 a\r2 b\r"), ["1 a\n2 b\n"; 2].map(|text| Ok(text.to_owned())));
        assert_eq!(read(b"1\r\n2\r3\n"), ["1\n2\n3\n"; 2].map(|text| Ok(text.to_owned())));
        assert_eq!(read(b"1\r\n2\r\n"), ["1\r\n2\r\n"; 2].map(|text| Ok(text.to_owned())));
        assert!(read(b"1\r2\r\xff")[0].as_ref().unwrap_err().contains(", line 3: is not UTF-8"));
    }

    #[test]
    fn binary_text_is_refused_with_its_line() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), b"fine\n\xff\xfe").unwrap();
        assert!(read_text(file.path()).unwrap_err().to_string().contains(", line 2: is not UTF-8 text"));
    }
}
