//! Reading of whole files, and splitting of text files into lines and fields.

use crate::IoError;
use crate::excerpt::excerpt;
use std::path::Path;

/// The whole file.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, IoError> {
    std::fs::read(path).map_err(IoError::system(path, "read"))
}

/// The whole file as text.
pub(crate) fn read_text(path: &Path) -> Result<String, IoError> {
    let text = String::from_utf8(read_bytes(path)?);
    text.map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        IoError::line(path, line, "is not UTF-8 text")
    })
}

/// The lines that say something, with their numbers from 1: no blank ones, no comments (`#`).
pub(crate) fn content_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// The fields of a line, between blanks or commas.
pub(crate) fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| c.is_whitespace() || c == ',').filter(|field| !field.is_empty())
}

/// The line's numbers, each named and finite, after the stamp: `(stamp, numbers)`.
pub(crate) fn stamped_numbers<const N: usize>(
    path: &Path,
    (number, line): (usize, &str),
    names: [&str; N],
) -> Result<(trundle_core::Stamp, [f64; N]), IoError> {
    let parts: Vec<&str> = fields(line).collect();
    if parts.len() != N + 1 {
        let problem = format!("{} fields, expected {}: timestamp {}", parts.len(), N + 1, names.join(" "));
        return Err(IoError::line(path, number, problem));
    }
    let stamp =
        crate::parse_stamp(parts[0]).map_err(|invalid| IoError::line(path, number, invalid.to_string()))?;
    let mut numbers = [0.0; N];
    for ((slot, text), name) in numbers.iter_mut().zip(&parts[1..]).zip(names) {
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        let problem = || format!("{name} is '{}', expected a finite number", excerpt(text));
        *slot = value.ok_or_else(|| IoError::line(path, number, problem()))?;
    }
    Ok((stamp, numbers))
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
    fn binary_text_is_refused_with_its_line() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), b"fine\n\xff\xfe").unwrap();
        assert!(read_text(file.path()).unwrap_err().to_string().ends_with(", line 2: is not UTF-8 text"));
    }
}
